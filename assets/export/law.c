/* $title
 *
 * See $prefix.h. Made by Schuler Bench $version; the numbers are those of the scenario "$scenario",
 * method "$method", at $rate_hz Hz.
$sources
 */
#include "$prefix.h"

#include <math.h>

$constants

$functions

void ${prefix}_init(${prefix}_state *s, const ${prefix}_start *at)
{
    static const ${prefix}_state zero;
    *s = zero;
$initial
}

void ${prefix}_step(${prefix}_state *s, const ${prefix}_in *in, ${prefix}_out *out)
{
$call
}
