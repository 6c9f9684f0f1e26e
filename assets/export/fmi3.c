/* $title
 *
 * Functional Mock-up Interface 3.0, co-simulation, around $prefix.c: every communication step of $step_s s is
 * one call of the law with the inputs of its begin; the outputs hold from there on. This file is yours.
 */
#include "$prefix.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#define EXPORTED __declspec(dllexport)
#else
#define EXPORTED __attribute__((visibility("default")))
#endif

typedef void *fmi3Instance;
typedef uint32_t fmi3ValueReference;
typedef double fmi3Float64;
typedef int32_t fmi3Int32;
typedef bool fmi3Boolean;
typedef const char *fmi3String;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;

#define INPUTS $inputs
#define OUTPUTS $outputs
#define TOKEN "$token"

/* Value references: 0 the time, then the inputs, then the outputs. */
typedef struct {
    ${prefix}_state state;
    double values[1 + INPUTS + OUTPUTS];
    bool begun;
} Law;

static void begin(Law *law)
{
    ${prefix}_start at;
    memset(&at, 0, sizeof at);
    ${prefix}_init(&law->state, &at);
    law->begun = true;
}

static void call(Law *law)
{
    const double *values = law->values + 1;
    double *found = law->values + 1 + INPUTS;
    ${prefix}_in in;
    ${prefix}_out out;
    memset(&in, 0, sizeof in);
$take
    if (!law->begun) {
        begin(law);
    }
    ${prefix}_step(&law->state, &in, &out);
$give
}

EXPORTED const char *fmi3GetVersion(void)
{
    return "3.0";
}

EXPORTED fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3Boolean events, fmi3Boolean early, const fmi3ValueReference required[], size_t count, void *environment,
    void *log, void *update)
{
    (void)name; (void)resources; (void)visible; (void)logging; (void)events; (void)early; (void)required;
    (void)count; (void)environment; (void)log; (void)update;
    if (token == NULL || strcmp(token, TOKEN) != 0) {
        return NULL;
    }
    return calloc(1, sizeof(Law));
}

EXPORTED void fmi3FreeInstance(fmi3Instance instance)
{
    free(instance);
}

EXPORTED fmi3Status fmi3EnterInitializationMode(
    fmi3Instance instance, fmi3Boolean tolerant, fmi3Float64 tolerance, fmi3Float64 start, fmi3Boolean stops,
    fmi3Float64 stop)
{
    (void)tolerant; (void)tolerance; (void)stops; (void)stop;
    ((Law *)instance)->values[0] = start;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3Reset(fmi3Instance instance)
{
    memset(instance, 0, sizeof(Law));
    return fmi3OK;
}

static fmi3Status done(fmi3Instance instance)
{
    return instance == NULL ? fmi3Error : fmi3OK;
}

EXPORTED fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) { return done(instance); }
EXPORTED fmi3Status fmi3Terminate(fmi3Instance instance) { return done(instance); }
EXPORTED fmi3Status fmi3EnterStepMode(fmi3Instance instance) { return done(instance); }
EXPORTED fmi3Status fmi3EnterEventMode(fmi3Instance instance) { return done(instance); }
EXPORTED fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance) { return done(instance); }
EXPORTED fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance) { return done(instance); }

EXPORTED fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean on, size_t n, const fmi3String names[])
{
    (void)on; (void)n; (void)names;
    return done(instance);
}

EXPORTED fmi3Status fmi3UpdateDiscreteStates(
    fmi3Instance instance, fmi3Boolean *again, fmi3Boolean *ends, fmi3Boolean *nominals, fmi3Boolean *values,
    fmi3Boolean *next, fmi3Float64 *time)
{
    *again = *ends = *nominals = *values = *next = false;
    *time = 0.0;
    return done(instance);
}

EXPORTED fmi3Status fmi3DoStep(
    fmi3Instance instance, fmi3Float64 now, fmi3Float64 size, fmi3Boolean kept, fmi3Boolean *event,
    fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *reached)
{
    Law *law = instance;
    const long calls = lround(size / ${guard}_STEP_S);
    (void)kept;
    *event = *terminate = *early = false;
    *reached = now;
    if (calls < 1 || fabs((double)calls * ${guard}_STEP_S - size) > 1e-6 * ${guard}_STEP_S) {
        return fmi3Error; /* the law is called each ${guard}_STEP_S and never between */
    }
    for (long i = 0; i < calls; i++) {
        call(law);
    }
    *reached = law->values[0] = now + size;
    return fmi3OK;
}

/* Numbers by their value references. */
static fmi3Status check(const fmi3ValueReference references[], size_t count, bool set)
{
    for (size_t i = 0; i < count; i++) {
        if (references[i] > (set ? INPUTS : INPUTS + OUTPUTS) || (set && references[i] == 0)) {
            return fmi3Error;
        }
    }
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetFloat64(
    fmi3Instance instance, const fmi3ValueReference references[], size_t count, fmi3Float64 values[], size_t n)
{
    if (n != count || check(references, count, false) != fmi3OK) {
        return fmi3Error;
    }
    for (size_t i = 0; i < count; i++) {
        values[i] = ((Law *)instance)->values[references[i]];
    }
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetFloat64(
    fmi3Instance instance, const fmi3ValueReference references[], size_t count, const fmi3Float64 values[], size_t n)
{
    if (n != count || check(references, count, true) != fmi3OK) {
        return fmi3Error;
    }
    for (size_t i = 0; i < count; i++) {
        ((Law *)instance)->values[references[i]] = values[i];
    }
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetInt32(
    fmi3Instance instance, const fmi3ValueReference references[], size_t count, fmi3Int32 values[], size_t n)
{
    if (n != count || check(references, count, false) != fmi3OK) {
        return fmi3Error;
    }
    for (size_t i = 0; i < count; i++) {
        values[i] = (fmi3Int32)((Law *)instance)->values[references[i]];
    }
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetInt32(
    fmi3Instance instance, const fmi3ValueReference references[], size_t count, const fmi3Int32 values[], size_t n)
{
    if (n != count || check(references, count, true) != fmi3OK) {
        return fmi3Error;
    }
    for (size_t i = 0; i < count; i++) {
        ((Law *)instance)->values[references[i]] = values[i];
    }
    return fmi3OK;
}

/* What this unit does not have: it is asked for none of it, since modelDescription.xml does not offer it. */
EXPORTED fmi3Instance fmi3InstantiateModelExchange(void) { return NULL; }
EXPORTED fmi3Instance fmi3InstantiateScheduledExecution(void) { return NULL; }
#define NOT_THERE(name) \
    EXPORTED fmi3Status name(fmi3Instance instance) { (void)instance; return fmi3Error; }
$missing
