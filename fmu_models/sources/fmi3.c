/* The functions of FMI 3.0, model exchange and co-simulation with intermediate update. */
#include "fmi3Functions.h"
#include "unit.h"
#include <stdlib.h>
#include <string.h>

#define UNIT ((Unit *)c)

static void say(Unit *unit, int failed, const char *sentence) {
    fmi3LogMessageCallback logger = (fmi3LogMessageCallback)unit->logger;
    if (logger && (failed || unit->logging))
        logger(unit->environment, failed ? fmi3Error : fmi3Warning, failed ? "error" : "warning", sentence);
}

static int between(Unit *unit, double time) {
    fmi3IntermediateUpdateCallback update = (fmi3IntermediateUpdateCallback)unit->update;
    fmi3Boolean wanted = fmi3False;
    fmi3Float64 at = time;
    unit->state.stale = 1;
    update(unit->environment, time, fmi3False, fmi3True, fmi3True, unit->early != 0, &wanted, &at);
    return unit->early && wanted;
}

static fmi3Status status_of(int failed) { return failed ? fmi3Error : fmi3OK; }

static fmi3Status lacking(fmi3Instance c) {
    say(UNIT, 1, "this function is not supported: the unit has neither clocks nor arrays");
    return fmi3Error;
}

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String categories[]) {
    (void)n, (void)categories;
    UNIT->logging = on;
    return fmi3OK;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                          fmi3Boolean visible, fmi3Boolean logging,
                                          fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger) {
    Unit *unit = calloc(1, sizeof(Unit));
    (void)resources, (void)visible;
    if (!unit) return 0;
    unit->exchange = 1;
    strncpy(unit->name, name ? name : "", sizeof unit->name - 1);
    unit->say = say;
    unit->logging = logging;
    unit->logger = (void (*)(void))logger;
    unit->environment = environment;
    if (!token || strcmp(token, TOKEN)) {
        say(unit, 1, "the token differs: modelDescription.xml belongs to another unit");
        free(unit);
        return 0;
    }
    unit_reset(unit);
    return unit;
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                                         fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean event_mode,
                                         fmi3Boolean early, const fmi3ValueReference required[], size_t n_required,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                         fmi3IntermediateUpdateCallback update) {
    Unit *unit = fmi3InstantiateModelExchange(name, token, resources, visible, logging, environment, logger);
    (void)event_mode, (void)required, (void)n_required;
    if (unit) unit->exchange = 0;
    if (unit && update) {
        unit->update = (void (*)(void))update;
        unit->between = between;
        unit->early = early;
    }
    return unit;
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                               fmi3Boolean visible, fmi3Boolean logging,
                                               fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                               fmi3ClockUpdateCallback clock, fmi3LockPreemptionCallback lock,
                                               fmi3UnlockPreemptionCallback unlock) {
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)environment, (void)logger;
    (void)clock, (void)lock, (void)unlock;
    return 0;
}

void fmi3FreeInstance(fmi3Instance c) { free(c); }

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean with_tolerance, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean with_stop, fmi3Float64 stop) {
    (void)with_stop, (void)stop;
    UNIT->state.v[V_time] = start;
    return status_of(with_tolerance && unit_set(UNIT, V_tolerance, 'r', tolerance));
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c) {
    return status_of(unit_initialise(UNIT, UNIT->state.v[V_time]));
}

#define NOTHING_TO_DO(NAME)                                                                                     \
    fmi3Status fmi3##NAME(fmi3Instance c) {                                                                     \
        (void)c;                                                                                                \
        return fmi3OK;                                                                                          \
    }

NOTHING_TO_DO(EnterEventMode)
NOTHING_TO_DO(EnterContinuousTimeMode)
NOTHING_TO_DO(EnterStepMode)
NOTHING_TO_DO(EvaluateDiscreteStates)
NOTHING_TO_DO(Terminate)

fmi3Status fmi3EnterConfigurationMode(fmi3Instance c) { return lacking(c); }
fmi3Status fmi3ExitConfigurationMode(fmi3Instance c) { return lacking(c); }

fmi3Status fmi3Reset(fmi3Instance c) {
    unit_reset(UNIT);
    return fmi3OK;
}

#define GET_AND_SET(NAME, TYPE, CODE)                                                                           \
    fmi3Status fmi3Get##NAME(fmi3Instance c, const fmi3ValueReference vr[], size_t n, TYPE values[],            \
                             size_t n_values) {                                                                 \
        if (n_values < n) return fmi3Error;                                                                     \
        for (size_t i = 0; i < n; i++) {                                                                        \
            if (!unit_has(UNIT, vr[i], CODE)) return fmi3Error;                                                 \
            values[i] = (TYPE)unit_get(UNIT, vr[i]);                                                            \
        }                                                                                                       \
        return fmi3OK;                                                                                          \
    }                                                                                                           \
    fmi3Status fmi3Set##NAME(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const TYPE values[],      \
                             size_t n_values) {                                                                 \
        if (n_values < n) return fmi3Error;                                                                     \
        for (size_t i = 0; i < n; i++)                                                                          \
            if (unit_set(UNIT, vr[i], CODE, (double)values[i])) return fmi3Error;                               \
        return fmi3OK;                                                                                          \
    }

/* No variable has the code "-". */
GET_AND_SET(Float64, fmi3Float64, 'r')
GET_AND_SET(Int32, fmi3Int32, 'n')
GET_AND_SET(Boolean, fmi3Boolean, 'b')
GET_AND_SET(Float32, fmi3Float32, '-')
GET_AND_SET(Int8, fmi3Int8, '-')
GET_AND_SET(UInt8, fmi3UInt8, '-')
GET_AND_SET(Int16, fmi3Int16, '-')
GET_AND_SET(UInt16, fmi3UInt16, '-')
GET_AND_SET(UInt32, fmi3UInt32, '-')
GET_AND_SET(Int64, fmi3Int64, '-')
GET_AND_SET(UInt64, fmi3UInt64, '-')

fmi3Status fmi3GetClock(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Clock values[]) {
    (void)vr, (void)values;
    return n ? lacking(c) : fmi3OK;
}

fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3Clock values[]) {
    (void)vr, (void)values;
    return n ? lacking(c) : fmi3OK;
}

fmi3Status fmi3GetString(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3String values[], size_t m) {
    (void)vr, (void)values, (void)m;
    return n ? lacking(c) : fmi3OK;
}

fmi3Status fmi3SetString(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3String values[],
                         size_t m) {
    (void)vr, (void)values, (void)m;
    return n ? lacking(c) : fmi3OK;
}

fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference vr[], size_t n, size_t sizes[],
                         fmi3Binary values[], size_t m) {
    (void)vr, (void)sizes, (void)values, (void)m;
    return n ? lacking(c) : fmi3OK;
}

fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const size_t sizes[],
                         const fmi3Binary values[], size_t m) {
    (void)vr, (void)sizes, (void)values, (void)m;
    return n ? lacking(c) : fmi3OK;
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference vr, size_t *n) {
    (void)vr, (void)n;
    return lacking(c);
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference dependent, size_t of_dependent[],
                                       fmi3ValueReference independents[], size_t of_independents[],
                                       fmi3DependencyKind kinds[], size_t n) {
    (void)dependent, (void)of_dependent, (void)independents, (void)of_independents, (void)kinds, (void)n;
    return lacking(c);
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *kept) {
    if (!*kept) *kept = malloc(sizeof(State));
    if (!*kept) return fmi3Error;
    memcpy(*kept, &UNIT->state, sizeof(State));
    return fmi3OK;
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState kept) {
    memcpy(&UNIT->state, kept, sizeof(State));
    return fmi3OK;
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *kept) {
    (void)c;
    free(*kept);
    *kept = 0;
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState kept, size_t *size) {
    (void)c, (void)kept;
    *size = sizeof(State);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState kept, fmi3Byte bytes[], size_t size) {
    (void)c;
    if (size < sizeof(State)) return fmi3Error;
    memcpy(bytes, kept, sizeof(State));
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *kept) {
    (void)c;
    if (size != sizeof(State)) return fmi3Error;
    if (!*kept) *kept = malloc(sizeof(State));
    if (!*kept) return fmi3Error;
    memcpy(*kept, bytes, sizeof(State));
    return fmi3OK;
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknowns[], size_t n_unknowns,
                                        const fmi3ValueReference knowns[], size_t n_knowns,
                                        const fmi3Float64 seed[], size_t n_seed, fmi3Float64 found[],
                                        size_t n_found) {
    double d[N_VARIABLES] = {0.0};
    if (n_seed < n_knowns || n_found < n_unknowns) return fmi3Error;
    for (size_t i = 0; i < n_knowns; i++) {
        if (!unit_has(UNIT, knowns[i], 'r')) return fmi3Error;
        d[knowns[i]] += seed[i];
    }
    unit_tangent(UNIT, d);
    for (size_t i = 0; i < n_unknowns; i++) {
        if (!unit_has(UNIT, unknowns[i], 'r')) return fmi3Error;
        found[i] = d[unknowns[i]];
    }
    return fmi3OK;
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, const fmi3ValueReference unknowns[], size_t n_unknowns,
                                    const fmi3ValueReference knowns[], size_t n_knowns, const fmi3Float64 seed[],
                                    size_t n_seed, fmi3Float64 found[], size_t n_found) {
    (void)unknowns, (void)n_unknowns, (void)knowns, (void)n_knowns, (void)seed, (void)n_seed, (void)found;
    (void)n_found;
    return lacking(c);
}

fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Float64 a[], fmi3IntervalQualifier q[]) {
    (void)vr, (void)n, (void)a, (void)q;
    return lacking(c);
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3UInt64 a[], fmi3UInt64 b[], fmi3IntervalQualifier q[]) {
    (void)vr, (void)n, (void)a, (void)b, (void)q;
    return lacking(c);
}

fmi3Status fmi3GetShiftDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Float64 a[]) {
    (void)vr, (void)n, (void)a;
    return lacking(c);
}

fmi3Status fmi3GetShiftFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3UInt64 a[], fmi3UInt64 b[]) {
    (void)vr, (void)n, (void)a, (void)b;
    return lacking(c);
}

fmi3Status fmi3SetIntervalDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3Float64 a[]) {
    (void)vr, (void)n, (void)a;
    return lacking(c);
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3UInt64 a[], const fmi3UInt64 b[]) {
    (void)vr, (void)n, (void)a, (void)b;
    return lacking(c);
}

fmi3Status fmi3SetShiftDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3Float64 a[]) {
    (void)vr, (void)n, (void)a;
    return lacking(c);
}

fmi3Status fmi3SetShiftFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3UInt64 a[], const fmi3UInt64 b[]) {
    (void)vr, (void)n, (void)a, (void)b;
    return lacking(c);
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate,
                                    fmi3Boolean *nominals_changed, fmi3Boolean *states_changed,
                                    fmi3Boolean *next_defined, fmi3Float64 *next) {
    *again = *terminate = *nominals_changed = *next_defined = fmi3False;
    *next = 0.0;
    *states_changed = model_change(&UNIT->state) != 0;
    UNIT->state.stale = 1;
    return fmi3OK;
}

/* Model exchange. */

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean final, fmi3Boolean *enter_event_mode,
                                       fmi3Boolean *terminate) {
    (void)c, (void)final;
    *enter_event_mode = *terminate = fmi3False;
    return fmi3OK;
}

fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time) {
    UNIT->state.v[V_time] = time;
    UNIT->state.stale = 1;
    return fmi3OK;
}

fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t n) {
    for (size_t i = 0; i < n && i < N_STATES; i++) UNIT->state.v[STATES[i]] = x[i];
    UNIT->state.stale = 1;
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 derivatives[], size_t n) {
    unit_refresh(UNIT);
    for (size_t i = 0; i < n && i < N_STATES; i++) derivatives[i] = UNIT->state.v[DERIVATIVES[i]];
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *n) {
    (void)c;
#ifdef V_indicator
    *n = 1;
#else
    *n = 0;
#endif
    return fmi3OK;
}

fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 indicators[], size_t n) {
    (void)c, (void)indicators, (void)n;
#ifdef V_indicator
    unit_refresh(UNIT);
    if (n > 0) indicators[0] = UNIT->state.v[V_indicator];
#endif
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *n) {
    (void)c;
    *n = N_STATES;
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n) {
    for (size_t i = 0; i < n && i < N_STATES; i++) x[i] = UNIT->state.v[STATES[i]];
    return fmi3OK;
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 nominal[], size_t n) {
    for (size_t i = 0; i < n && i < N_STATES; i++) nominal[i] = UNIT->state.nominal[i];
    return fmi3OK;
}

/* Co-simulation. */

fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                    const fmi3Int32 order[], fmi3Float64 values[], size_t n_values) {
    double d[N_VARIABLES] = {0.0};
    if (n_values < n) return fmi3Error;
    unit_refresh(UNIT);
    for (size_t i = 0; i < N_STATES; i++) d[STATES[i]] = UNIT->state.v[DERIVATIVES[i]];
    unit_tangent(UNIT, d);
    for (size_t i = 0; i < n; i++) {
        if (!unit_has(UNIT, vr[i], 'r') || order[i] != 1) return fmi3Error;
        values[i] = d[vr[i]];
    }
    return fmi3OK;
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 length, fmi3Boolean final,
                      fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *reached) {
    int result;
    (void)final;
    UNIT->state.v[V_time] = time;
    result = unit_advance(UNIT, time + length);
    *event = *terminate = fmi3False;
    *early = result == 2;
    *reached = UNIT->state.v[V_time];
    UNIT->state.stale = 1;
    return status_of(result == 1);
}

fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time) {
    (void)clock, (void)time;
    return lacking(c);
}
