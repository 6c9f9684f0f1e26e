/* Replays vectors.csv: $hours h of the scenario "$scenario", method "$method".
 *
 *     cc -std=c99 -O2 $prefix.c test.c -lm && ./a.out vectors.csv
 *
 * prints the largest deviation of each output from the run of Schuler Bench and exits 0 where all lie within
 * their bounds, 1 where one does not, 2 where the vectors cannot be read.
 */
#include "$prefix.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define INPUTS $inputs
#define OUTPUTS $outputs
#define ROWS ${rows}L

static const char *const names[OUTPUTS] = {
$names
};

static const double bounds[OUTPUTS] = {$bounds}; /* of the peak of each output */

static int read_row(FILE *file, double *values)
{
    static char line[$line_length];
    if (fgets(line, (int)sizeof line, file) == NULL) {
        return 0;
    }
    char *at = line;
    for (int i = 0; i < INPUTS + OUTPUTS; i++) {
        char *end = NULL;
        values[i] = strtod(at, &end);
        if (end == at) {
            return -1;
        }
        at = end + (*end == ',');
    }
    return 1;
}

int main(int count, char **words)
{
    static ${prefix}_state state;
    const ${prefix}_start start = {$start};
    double values[INPUTS + OUTPUTS], deviation[OUTPUTS] = {0.0}, peak[OUTPUTS] = {0.0};
    static char header[$line_length];
    long rows = 0;
    int read = 0, beyond = 0;
    FILE *file = count > 1 ? fopen(words[1], "r") : NULL;
    if (file == NULL || fgets(header, (int)sizeof header, file) == NULL) {
        fprintf(stderr, "%s: cannot be read\n", count > 1 ? words[1] : "vectors.csv");
        return 2;
    }
    ${prefix}_init(&state, &start);
    while ((read = read_row(file, values)) == 1) {
        ${prefix}_in in;
        ${prefix}_out out;
        memset(&in, 0, sizeof in);
$take
        ${prefix}_step(&state, &in, &out);
        const double found[OUTPUTS] = {
$found
        };
        for (int i = 0; i < OUTPUTS; i++) {
            const double expected = values[INPUTS + i], off = fabs(found[i] - expected);
            if (!(off <= deviation[i])) {
                deviation[i] = off;
            }
            peak[i] = fabs(expected) > peak[i] ? fabs(expected) : peak[i];
        }
        rows++;
    }
    fclose(file);
    if (read < 0 || rows != ROWS) {
        fprintf(stderr, "%s: %ld rows that can be read, %ld expected\n", words[1], rows, ROWS);
        return 2;
    }
    printf("%-22s %13s %13s %13s %13s\n", "output", "peak", "deviation", "of the peak", "bound");
    for (int i = 0; i < OUTPUTS; i++) {
        const double share = peak[i] > 0.0 ? deviation[i] / peak[i] : deviation[i];
        const int within = deviation[i] <= bounds[i] * peak[i];
        printf("%-22s %13.6g %13.6g %13.6g %13.6g%s\n", names[i], peak[i], deviation[i], share, bounds[i],
               within ? "" : "  BEYOND THE BOUND");
        beyond += !within;
    }
    printf("%ld steps: %s\n", rows, beyond ? "not within the bounds" : "within the bounds");
    return beyond ? 1 : 0;
}
