/* The functions of FMI 3.0, model exchange and co-simulation with intermediate update. */
#include "fmi3Functions.h"

#define FMI(NAME) fmi3##NAME
#define OF_STATE(VERB, REST) fmi3##VERB##FMUState##REST
#define DESERIALIZE fmi3DeserializeFMUState
#define GET_DERIVATIVES fmi3GetContinuousStateDerivatives
#define START fmi3EnterInitializationMode
#define N_VALUES , size_t n_values
#define TOO_FEW n_values < n
#include "standard.h"

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

static fmi3Status lacking(fmi3Instance c) {
    say(UNIT, 1, "this function is not supported: the unit has neither clocks nor arrays");
    return fmi3Error;
}

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                          fmi3Boolean visible, fmi3Boolean logging,
                                          fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger) {
    Unit unit = {.exchange = 1, .say = say, .logging = logging, .environment = environment};
    unit.logger = (void (*)(void))logger;
    return created(unit, name, token, "the token differs: modelDescription.xml belongs to another unit");
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                                         fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean event_mode,
                                         fmi3Boolean early, const fmi3ValueReference required[], size_t n_required,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                         fmi3IntermediateUpdateCallback update) {
    Unit *unit = fmi3InstantiateModelExchange(name, token, resources, visible, logging, environment, logger);
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
    return 0;
}

NOTHING_TO_DO(EnterStepMode)
NOTHING_TO_DO(EvaluateDiscreteStates)

/* No variable has the code "-". */
GET_AND_SET(Float64, Float64, 'r')
GET_AND_SET(Int32, Int32, 'n')
GET_AND_SET(Boolean, Boolean, 'b')
GET_AND_SET(Float32, Float32, '-')
GET_AND_SET(Int8, Int8, '-')
GET_AND_SET(UInt8, UInt8, '-')
GET_AND_SET(Int16, Int16, '-')
GET_AND_SET(UInt16, UInt16, '-')
GET_AND_SET(UInt32, UInt32, '-')
GET_AND_SET(Int64, Int64, '-')
GET_AND_SET(UInt64, UInt64, '-')

/* Functions for what the unit lacks; those of variables may be called for none. */
#define LACKING(NAME, ...)                                                                                      \
    fmi3Status fmi3##NAME(fmi3Instance c, __VA_ARGS__) { return lacking(c); }
#define LACKING_VARIABLES(NAME, ...)                                                                            \
    fmi3Status fmi3##NAME(fmi3Instance c, const fmi3ValueReference vr[], size_t n, __VA_ARGS__) {               \
        return n ? lacking(c) : fmi3OK;                                                                         \
    }
#define REFERENCES const fmi3ValueReference vr[], size_t n

LACKING_VARIABLES(GetClock, fmi3Clock values[])
LACKING_VARIABLES(SetClock, const fmi3Clock values[])
LACKING_VARIABLES(GetString, fmi3String values[], size_t m)
LACKING_VARIABLES(SetString, const fmi3String values[], size_t m)
LACKING_VARIABLES(GetBinary, size_t sizes[], fmi3Binary values[], size_t m)
LACKING_VARIABLES(SetBinary, const size_t sizes[], const fmi3Binary values[], size_t m)

fmi3Status fmi3EnterConfigurationMode(fmi3Instance c) { return lacking(c); }
fmi3Status fmi3ExitConfigurationMode(fmi3Instance c) { return lacking(c); }
LACKING(ActivateModelPartition, fmi3ValueReference clock, fmi3Float64 time)
LACKING(GetNumberOfVariableDependencies, fmi3ValueReference vr, size_t *n)
LACKING(GetVariableDependencies, fmi3ValueReference dependent, size_t of_dependent[],
        fmi3ValueReference independents[], size_t of_independents[], fmi3DependencyKind kinds[], size_t n)
LACKING(GetAdjointDerivative, const fmi3ValueReference unknowns[], size_t n_unknowns, const fmi3ValueReference knowns[],
        size_t n_knowns, const fmi3Float64 seed[], size_t n_seed, fmi3Float64 found[], size_t n_found)
LACKING(GetIntervalDecimal, REFERENCES, fmi3Float64 a[], fmi3IntervalQualifier q[])
LACKING(GetIntervalFraction, REFERENCES, fmi3UInt64 a[], fmi3UInt64 b[], fmi3IntervalQualifier q[])
LACKING(GetShiftDecimal, REFERENCES, fmi3Float64 a[])
LACKING(GetShiftFraction, REFERENCES, fmi3UInt64 a[], fmi3UInt64 b[])
LACKING(SetIntervalDecimal, REFERENCES, const fmi3Float64 a[])
LACKING(SetIntervalFraction, REFERENCES, const fmi3UInt64 a[], const fmi3UInt64 b[])
LACKING(SetShiftDecimal, REFERENCES, const fmi3Float64 a[])
LACKING(SetShiftFraction, REFERENCES, const fmi3UInt64 a[], const fmi3UInt64 b[])

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknowns[], size_t n_unknowns,
                                        const fmi3ValueReference knowns[], size_t n_knowns,
                                        const fmi3Float64 seed[], size_t n_seed, fmi3Float64 found[],
                                        size_t n_found) {
    if (n_seed < n_knowns || n_found < n_unknowns) return fmi3Error;
    return along(c, unknowns, n_unknowns, knowns, n_knowns, seed, found);
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

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *n) {
#ifdef V_indicator
    *n = 1;
#else
    *n = 0;
#endif
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *n) {
    *n = N_STATES;
    return fmi3OK;
}

/* Co-simulation. */

fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                    const fmi3Int32 order[], fmi3Float64 values[], size_t n_values) {
    return n_values < n ? fmi3Error : along_time(c, vr, n, order, values);
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 length, fmi3Boolean final,
                      fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *reached) {
    int result;
    UNIT->state.v[V_time] = time;
    result = unit_advance(UNIT, time + length);
    *event = *terminate = fmi3False;
    *early = result == 2;
    *reached = UNIT->state.v[V_time];
    UNIT->state.stale = 1;
    return status_of(result == 1);
}
