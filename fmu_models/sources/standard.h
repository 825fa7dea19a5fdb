/* The functions that FMI 2 and 3 share, except for the names that fmi2.c and fmi3.c define before they include this. */
#include "unit.h"
#include <stdlib.h>
#include <string.h>

#define UNIT ((Unit *)c)

static FMI(Status) status_of(int failed) { return failed ? FMI(Error) : FMI(OK); }

/* Returns a new unit for importers that know its token. */
static Unit *created(Unit unit, const char *name, const char *token, const char *refusal) {
    Unit *kept = calloc(1, sizeof(Unit));
    if (!kept) return 0;
    strncpy(unit.name, name ? name : "", sizeof unit.name - 1);
    *kept = unit;
    if (token && !strcmp(token, TOKEN)) {
        unit_reset(kept);
        return kept;
    }
    kept->say(kept, 1, refusal);
    free(kept);
    return 0;
}

FMI(Status) FMI(SetDebugLogging)(void *c, FMI(Boolean) on, size_t n, const FMI(String) categories[]) {
    UNIT->logging = on;
    return FMI(OK);
}

void FMI(FreeInstance)(void *c) { free(c); }

FMI(Status) START(void *c, FMI(Boolean) with_tolerance, double tolerance, double start, FMI(Boolean) with_stop, double stop) {
    UNIT->state.v[V_time] = start;
    return status_of(with_tolerance && unit_set(UNIT, V_tolerance, 'r', tolerance));
}

FMI(Status) FMI(ExitInitializationMode)(void *c) { return status_of(unit_initialise(UNIT, UNIT->state.v[V_time])); }

FMI(Status) FMI(Reset)(void *c) {
    unit_reset(UNIT);
    return FMI(OK);
}

#define NOTHING_TO_DO(NAME)                                                                                     \
    FMI(Status) FMI(NAME)(void *c) { return FMI(OK); }

NOTHING_TO_DO(EnterEventMode)
NOTHING_TO_DO(EnterContinuousTimeMode)
NOTHING_TO_DO(Terminate)

#define GET_AND_SET(NAME, TYPE, CODE)                                                                           \
    FMI(Status) FMI(Get##NAME)(void *c, const FMI(ValueReference) vr[], size_t n, FMI(TYPE) values[] N_VALUES) {  \
        if (TOO_FEW) return FMI(Error);                                                                         \
        for (size_t i = 0; i < n; i++) {                                                                        \
            if (!unit_has(UNIT, vr[i], CODE)) return FMI(Error);                                                \
            values[i] = (FMI(TYPE))unit_get(UNIT, vr[i]);                                                       \
        }                                                                                                       \
        return FMI(OK);                                                                                         \
    }                                                                                                           \
    FMI(Status) FMI(Set##NAME)(void *c, const FMI(ValueReference) vr[], size_t n,                               \
                               const FMI(TYPE) values[] N_VALUES) {                                             \
        if (TOO_FEW) return FMI(Error);                                                                         \
        for (size_t i = 0; i < n; i++)                                                                          \
            if (unit_set(UNIT, vr[i], CODE, (double)values[i])) return FMI(Error);                              \
        return FMI(OK);                                                                                         \
    }

FMI(Status) OF_STATE(Get, )(void *c, void **kept) {
    if (!*kept) *kept = malloc(sizeof(State));
    if (!*kept) return FMI(Error);
    memcpy(*kept, &UNIT->state, sizeof(State));
    return FMI(OK);
}

FMI(Status) OF_STATE(Set, )(void *c, void *kept) {
    memcpy(&UNIT->state, kept, sizeof(State));
    return FMI(OK);
}

FMI(Status) OF_STATE(Free, )(void *c, void **kept) {
    free(*kept);
    *kept = 0;
    return FMI(OK);
}

FMI(Status) OF_STATE(Serialized, Size)(void *c, void *kept, size_t *size) {
    *size = sizeof(State);
    return FMI(OK);
}

FMI(Status) OF_STATE(Serialize, )(void *c, void *kept, FMI(Byte) bytes[], size_t size) {
    if (size < sizeof(State)) return FMI(Error);
    memcpy(bytes, kept, sizeof(State));
    return FMI(OK);
}

FMI(Status) DESERIALIZE(void *c, const FMI(Byte) bytes[], size_t size, void **kept) {
    if (size != sizeof(State)) return FMI(Error);
    if (!*kept) *kept = malloc(sizeof(State));
    if (!*kept) return FMI(Error);
    memcpy(*kept, bytes, sizeof(State));
    return FMI(OK);
}

/* Derivatives of some variables along changes of others. */
static FMI(Status) along(void *c, const FMI(ValueReference) unknowns[], size_t n_unknowns,
                         const FMI(ValueReference) knowns[], size_t n_knowns, const double seed[], double found[]) {
    double d[N_VARIABLES] = {0.0};
    for (size_t i = 0; i < n_knowns; i++) {
        if (!unit_has(UNIT, knowns[i], 'r')) return FMI(Error);
        d[knowns[i]] += seed[i];
    }
    unit_tangent(UNIT, d);
    for (size_t i = 0; i < n_unknowns; i++) {
        if (!unit_has(UNIT, unknowns[i], 'r')) return FMI(Error);
        found[i] = d[unknowns[i]];
    }
    return FMI(OK);
}

/* Derivatives by time, of order 1 only. */
static FMI(Status) along_time(void *c, const FMI(ValueReference) vr[], size_t n, const int order[], double values[]) {
    FMI(ValueReference) states[N_STATES];
    double rates[N_STATES];
    unit_refresh(UNIT);
    for (size_t i = 0; i < N_STATES; i++) states[i] = STATES[i], rates[i] = UNIT->state.v[DERIVATIVES[i]];
    for (size_t i = 0; i < n; i++)
        if (order[i] != 1) return FMI(Error);
    return along(c, vr, n, states, N_STATES, rates, values);
}

/* Model exchange. */

FMI(Status) FMI(CompletedIntegratorStep)(void *c, FMI(Boolean) final, FMI(Boolean) *enter_event_mode,
                                         FMI(Boolean) *terminate) {
    *enter_event_mode = *terminate = FMI(False);
    return FMI(OK);
}

FMI(Status) FMI(SetTime)(void *c, double time) {
    UNIT->state.v[V_time] = time;
    UNIT->state.stale = 1;
    return FMI(OK);
}

FMI(Status) FMI(SetContinuousStates)(void *c, const double x[], size_t n) {
    for (size_t i = 0; i < n && i < N_STATES; i++) UNIT->state.v[STATES[i]] = x[i];
    UNIT->state.stale = 1;
    return FMI(OK);
}

FMI(Status) GET_DERIVATIVES(void *c, double derivatives[], size_t n) {
    unit_refresh(UNIT);
    for (size_t i = 0; i < n && i < N_STATES; i++) derivatives[i] = UNIT->state.v[DERIVATIVES[i]];
    return FMI(OK);
}

FMI(Status) FMI(GetEventIndicators)(void *c, double indicators[], size_t n) {
#ifdef V_indicator
    unit_refresh(UNIT);
    if (n > 0) indicators[0] = UNIT->state.v[V_indicator];
#endif
    return FMI(OK);
}

FMI(Status) FMI(GetContinuousStates)(void *c, double x[], size_t n) {
    for (size_t i = 0; i < n && i < N_STATES; i++) x[i] = UNIT->state.v[STATES[i]];
    return FMI(OK);
}

FMI(Status) FMI(GetNominalsOfContinuousStates)(void *c, double nominal[], size_t n) {
    for (size_t i = 0; i < n && i < N_STATES; i++) nominal[i] = UNIT->state.nominal[i];
    return FMI(OK);
}
