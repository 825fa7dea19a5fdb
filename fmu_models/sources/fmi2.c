/* The functions of FMI 2.0.5, model exchange and co-simulation. */
#include "fmi2Functions.h"
#include "unit.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define UNIT ((Unit *)c)

static void say(Unit *unit, int failed, const char *sentence) {
    fmi2CallbackLogger logger = (fmi2CallbackLogger)unit->logger;
    if (logger && (failed || unit->logging))
        logger(unit->environment, unit->name, failed ? fmi2Error : fmi2Warning, failed ? "error" : "warning", "%s",
               sentence);
}

static fmi2Status status_of(int failed) { return failed ? fmi2Error : fmi2OK; }

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[]) {
    (void)n, (void)categories;
    UNIT->logging = on;
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging) {
    Unit *unit = calloc(1, sizeof(Unit));
    (void)resources, (void)visible;
    if (!unit) return 0;
    unit->exchange = type == fmi2ModelExchange;
    strncpy(unit->name, name ? name : "", sizeof unit->name - 1);
    unit->say = say;
    unit->logging = logging;
    if (functions) {
        unit->logger = (void (*)(void))functions->logger;
        unit->environment = functions->componentEnvironment;
    }
    if (!guid || strcmp(guid, TOKEN)) {
        say(unit, 1, "the guid differs: modelDescription.xml belongs to another unit");
        free(unit);
        return 0;
    }
    unit_reset(unit);
    return unit;
}

void fmi2FreeInstance(fmi2Component c) { free(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean with_tolerance, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean with_stop, fmi2Real stop) {
    (void)with_stop, (void)stop;
    UNIT->state.v[V_time] = start;
    return status_of(with_tolerance && unit_set(UNIT, V_tolerance, 'r', tolerance));
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    return status_of(unit_initialise(UNIT, UNIT->state.v[V_time]));
}

fmi2Status fmi2Terminate(fmi2Component c) {
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c) {
    unit_reset(UNIT);
    return fmi2OK;
}

#define GET_AND_SET(NAME, TYPE, CODE)                                                                           \
    fmi2Status fmi2Get##NAME(fmi2Component c, const fmi2ValueReference vr[], size_t n, TYPE value[]) {          \
        for (size_t i = 0; i < n; i++) {                                                                        \
            if (!unit_has(UNIT, vr[i], CODE)) return fmi2Error;                                                 \
            value[i] = (TYPE)unit_get(UNIT, vr[i]);                                                             \
        }                                                                                                       \
        return fmi2OK;                                                                                          \
    }                                                                                                           \
    fmi2Status fmi2Set##NAME(fmi2Component c, const fmi2ValueReference vr[], size_t n, const TYPE value[]) {    \
        for (size_t i = 0; i < n; i++)                                                                          \
            if (unit_set(UNIT, vr[i], CODE, (double)value[i])) return fmi2Error;                                \
        return fmi2OK;                                                                                          \
    }

GET_AND_SET(Real, fmi2Real, 'r')
GET_AND_SET(Integer, fmi2Integer, 'n')
GET_AND_SET(Boolean, fmi2Boolean, 'b')

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2String value[]) {
    (void)vr, (void)value;
    return n ? status_of(!unit_has(UNIT, N_VARIABLES, 's')) : fmi2OK;
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2String value[]) {
    (void)vr, (void)value;
    return n ? status_of(!unit_has(UNIT, N_VARIABLES, 's')) : fmi2OK;
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *kept) {
    if (!*kept) *kept = malloc(sizeof(State));
    if (!*kept) return fmi2Error;
    memcpy(*kept, &UNIT->state, sizeof(State));
    return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate kept) {
    memcpy(&UNIT->state, kept, sizeof(State));
    return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *kept) {
    (void)c;
    free(*kept);
    *kept = 0;
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate kept, size_t *size) {
    (void)c, (void)kept;
    *size = sizeof(State);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate kept, fmi2Byte bytes[], size_t size) {
    (void)c;
    if (size < sizeof(State)) return fmi2Error;
    memcpy(bytes, kept, sizeof(State));
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *kept) {
    (void)c;
    if (size != sizeof(State)) return fmi2Error;
    if (!*kept) *kept = malloc(sizeof(State));
    if (!*kept) return fmi2Error;
    memcpy(*kept, bytes, sizeof(State));
    return fmi2OK;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t n_unknowns,
                                        const fmi2ValueReference knowns[], size_t n_knowns, const fmi2Real seed[],
                                        fmi2Real found[]) {
    double d[N_VARIABLES] = {0.0};
    for (size_t i = 0; i < n_knowns; i++) {
        if (!unit_has(UNIT, knowns[i], 'r')) return fmi2Error;
        d[knowns[i]] += seed[i];
    }
    unit_tangent(UNIT, d);
    for (size_t i = 0; i < n_unknowns; i++) {
        if (!unit_has(UNIT, unknowns[i], 'r')) return fmi2Error;
        found[i] = d[unknowns[i]];
    }
    return fmi2OK;
}

/* Model exchange. */

fmi2Status fmi2EnterEventMode(fmi2Component c) {
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info) {
    memset(info, 0, sizeof *info);
    info->valuesOfContinuousStatesChanged = model_change(&UNIT->state);
    UNIT->state.stale = 1;
    return fmi2OK;
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) {
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean final, fmi2Boolean *enter_event_mode,
                                       fmi2Boolean *terminate) {
    (void)c, (void)final;
    *enter_event_mode = *terminate = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) {
    UNIT->state.v[V_time] = time;
    UNIT->state.stale = 1;
    return fmi2OK;
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n) {
    for (size_t i = 0; i < n && i < N_STATES; i++) UNIT->state.v[STATES[i]] = x[i];
    UNIT->state.stale = 1;
    return fmi2OK;
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t n) {
    unit_refresh(UNIT);
    for (size_t i = 0; i < n && i < N_STATES; i++) derivatives[i] = UNIT->state.v[DERIVATIVES[i]];
    return fmi2OK;
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real indicators[], size_t n) {
    (void)c, (void)indicators, (void)n;
#ifdef V_indicator
    unit_refresh(UNIT);
    if (n > 0) indicators[0] = UNIT->state.v[V_indicator];
#endif
    return fmi2OK;
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n) {
    for (size_t i = 0; i < n && i < N_STATES; i++) x[i] = UNIT->state.v[STATES[i]];
    return fmi2OK;
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real nominal[], size_t n) {
    for (size_t i = 0; i < n && i < N_STATES; i++) nominal[i] = UNIT->state.nominal[i];
    return fmi2OK;
}

/* Co-simulation. */

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    (void)vr, (void)n, (void)order, (void)value;
    say(UNIT, 1, "derivatives of inputs are not taken");
    return fmi2Error;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                        const fmi2Integer order[], fmi2Real value[]) {
    double d[N_VARIABLES] = {0.0};
    unit_refresh(UNIT);
    for (size_t i = 0; i < N_STATES; i++) d[STATES[i]] = UNIT->state.v[DERIVATIVES[i]];
    unit_tangent(UNIT, d);
    for (size_t i = 0; i < n; i++) {
        if (!unit_has(UNIT, vr[i], 'r') || order[i] != 1) return fmi2Error;
        value[i] = d[vr[i]];
    }
    return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real length, fmi2Boolean final) {
    (void)final;
    UNIT->state.v[V_time] = time;
    return status_of(unit_advance(UNIT, time + length));
}

fmi2Status fmi2CancelStep(fmi2Component c) {
    (void)c;
    return fmi2Error;
}

#define NO_STATUS(NAME, TYPE)                                                                                   \
    fmi2Status fmi2Get##NAME(fmi2Component c, const fmi2StatusKind kind, TYPE *value) {                         \
        (void)c, (void)kind, (void)value;                                                                       \
        return fmi2Discard;                                                                                     \
    }

NO_STATUS(Status, fmi2Status)
NO_STATUS(IntegerStatus, fmi2Integer)
NO_STATUS(StringStatus, fmi2String)

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) {
    if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
    *value = UNIT->state.v[V_time];
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) {
    (void)c;
    if (kind != fmi2Terminated) return fmi2Discard;
    *value = fmi2False;
    return fmi2OK;
}
