/* The functions of FMI 2.0.5, model exchange and co-simulation. */
#include "fmi2Functions.h"

#define FMI(NAME) fmi2##NAME
#define OF_STATE(VERB, REST) fmi2##VERB##FMUstate##REST
#define DESERIALIZE fmi2DeSerializeFMUstate
#define GET_DERIVATIVES fmi2GetDerivatives
#define START fmi2SetupExperiment
#define N_VALUES
#define TOO_FEW 0
#include "standard.h"

static void say(Unit *unit, int failed, const char *sentence) {
    fmi2CallbackLogger logger = (fmi2CallbackLogger)unit->logger;
    if (logger && (failed || unit->logging))
        logger(unit->environment, unit->name, failed ? fmi2Error : fmi2Warning, failed ? "error" : "warning", "%s",
               sentence);
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging) {
    Unit unit = {.exchange = type == fmi2ModelExchange, .say = say, .logging = logging};
    if (functions) {
        unit.logger = (void (*)(void))functions->logger;
        unit.environment = functions->componentEnvironment;
    }
    return created(unit, name, guid, "the guid differs: modelDescription.xml belongs to another unit");
}

NOTHING_TO_DO(EnterInitializationMode)

GET_AND_SET(Real, Real, 'r')
GET_AND_SET(Integer, Integer, 'n')
GET_AND_SET(Boolean, Boolean, 'b')

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2String value[]) {
    return n ? status_of(!unit_has(UNIT, N_VARIABLES, 's')) : fmi2OK;
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2String value[]) {
    return n ? status_of(!unit_has(UNIT, N_VARIABLES, 's')) : fmi2OK;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t n_unknowns,
                                        const fmi2ValueReference knowns[], size_t n_knowns, const fmi2Real seed[],
                                        fmi2Real found[]) {
    return along(c, unknowns, n_unknowns, knowns, n_knowns, seed, found);
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info) {
    memset(info, 0, sizeof *info);
    info->valuesOfContinuousStatesChanged = model_change(&UNIT->state);
    UNIT->state.stale = 1;
    return fmi2OK;
}

/* Co-simulation. */

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    say(UNIT, 1, "derivatives of inputs are not taken");
    return fmi2Error;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                        const fmi2Integer order[], fmi2Real value[]) {
    return along_time(c, vr, n, order, value);
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real length, fmi2Boolean final) {
    UNIT->state.v[V_time] = time;
    return status_of(unit_advance(UNIT, time + length));
}

fmi2Status fmi2CancelStep(fmi2Component c) { return fmi2Error; }

#define NO_STATUS(NAME, TYPE)                                                                                   \
    fmi2Status fmi2Get##NAME(fmi2Component c, const fmi2StatusKind kind, TYPE *value) { return fmi2Discard; }

NO_STATUS(Status, fmi2Status)
NO_STATUS(IntegerStatus, fmi2Integer)
NO_STATUS(StringStatus, fmi2String)

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) {
    if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
    *value = UNIT->state.v[V_time];
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) {
    if (kind != fmi2Terminated) return fmi2Discard;
    *value = fmi2False;
    return fmi2OK;
}
