/* $title
 *
 * Made by Schuler Bench $version from the scenario "$scenario"
 * (SHA-256 $sha256), method "$method":
 * $description
 *
 * This file is yours: use, change and pass it on as you like.
 *
 * Call ${prefix}_init once, then ${prefix}_step every $step_s s ($rate_hz Hz), always at this rate.
 * Nothing is allocated, nothing is kept outside ${prefix}_state: as many laws may run side by side as there
 * are states.
 *
 * Axes: east, north, up. Rates are positive about them, yaw is clockwise from north. SI units and radians.
$usage
 */
#ifndef ${guard}_H
#define ${guard}_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ${guard}_STEP_S $step_s /* time between two calls, s */

/* Words of log_valid. A sample that is given again before the next one is due is the same sample. */
enum {
    ${guard}_LOG_INVALID = 0, /* the log has none, or one that does not count */
    ${guard}_LOG_SAMPLE = 1,  /* log_e_mps, log_n_mps are a sample */
    ${guard}_LOG_NOT_YET = 2  /* none yet: the last one holds for at most $hold_s s */
};

typedef struct {
$start_fields
} ${prefix}_start;

typedef struct {
$in_fields
} ${prefix}_in;

typedef struct {
$out_fields
} ${prefix}_out;

/* What the law remembers; to be touched by the functions below alone. */
typedef struct {
$state_fields
} ${prefix}_state;

void ${prefix}_init(${prefix}_state *s, const ${prefix}_start *at);
void ${prefix}_step(${prefix}_state *s, const ${prefix}_in *in, ${prefix}_out *out);

#ifdef __cplusplus
}
#endif

#endif
