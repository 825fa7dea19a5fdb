#include "unit.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Slip over speed below which the contact is at rest, unless the unit's own tolerance is smaller. */
#define AS_REST 1e-9

void unit_reset(Unit *unit) {
    memset(&unit->state, 0, sizeof unit->state);
    for (int i = 0; i < N_VARIABLES; i++) unit->state.v[i] = VARIABLES[i].start;
    unit->state.stale = 1;
}

static int refuse(Unit *unit, const char *sentence) {
    unit->say(unit, 1, sentence);
    return 1;
}

int unit_initialise(Unit *unit, double time) {
    State *s = &unit->state;
    char sentence[INTERNAL_DIGITS];
    double length, speed, rate, share;
    if (broken_rule(s->v, sentence, sizeof sentence)) return refuse(unit, sentence);
    s->v[V_time] = time;
    s->tolerance = s->v[V_tolerance];
    share = model_scales(s, &length, &speed, &rate);
    /* Limit the step so that errors fall with the tolerance even if communication steps are short. */
    s->longest = rate > 0.0 ? pow(s->tolerance, 0.2) / rate : HUGE_VAL;
    for (int i = 0; i < N_STATES; i++) {
        char kind = STATE_KINDS[i];
        s->nominal[i] = share * (kind == 'x' ? length : kind == 'v' ? speed : 1.0);
    }
    s->epsilon = s->v[V_regularisation];
    s->exact = model_exact(s->v);
    if (s->exact) s->epsilon = speed * (unit->exchange ? AS_REST : fmin(s->tolerance, AS_REST));
    /* the error grows with the power 3/2 of this speed, so it is proportional to the tolerance */
    s->leaving = speed * fmin(pow(s->tolerance, 2.0 / 3.0), 1e-6);
    s->step = 0.0;
    s->held_up = 0;
    s->leaves = 0;
    s->mode = SLIPS;
    s->initialised = 1;
    model_change(s);
#ifdef V_resting_points
    s->v[V_resting_points] = model_resting(s, 1.0);
#endif
    s->stale = 1;
    return 0;
}

void unit_refresh(Unit *unit) {
    if (unit->state.stale) {
        model_evaluate(&unit->state);
        unit->state.stale = 0;
    }
}

int unit_has(Unit *unit, size_t variable, char type) {
    char sentence[INTERNAL_DIGITS];
    if (variable < N_VARIABLES && VARIABLES[variable].type == type) return 1;
    snprintf(sentence, sizeof sentence, "value reference %lu: no variable of this type has it",
             (unsigned long)variable);
    unit->say(unit, 1, sentence);
    return 0;
}

double unit_get(Unit *unit, size_t variable) {
    char causality = VARIABLES[variable].causality;
    if (causality == 'o' || causality == 'd') {
        if (!unit->state.initialised) unit->state.epsilon = unit->state.v[V_regularisation];
        unit_refresh(unit);
    }
    return unit->state.v[variable];
}

int unit_set(Unit *unit, size_t variable, char type, double value) {
    const Variable *one = &VARIABLES[variable];
    char sentence[INTERNAL_DIGITS];
    if (!unit_has(unit, variable, type)) return 1;
    if (one->causality != 'i' && (one->causality == 'o' || one->causality == 'd' || one->causality == 't' ||
                                  unit->state.initialised)) {
        snprintf(sentence, sizeof sentence, "%s cannot be set%s", one->name,
                 one->causality == 'p' || one->causality == 's' ? " after initialisation" : "");
        return refuse(unit, sentence);
    }
    if (!(one->least <= value && value <= one->most)) {
        snprintf(sentence, sizeof sentence, "%s = %g%s%s: it must lie between %g and %g", one->name, value,
                 one->unit[0] ? " " : "", one->unit, one->least, one->most);
        return refuse(unit, sentence);
    }
    unit->state.v[variable] = value;
    unit->state.stale = 1;
    return 0;
}

void unit_tangent(Unit *unit, double d[N_VARIABLES]) {
    unit_refresh(unit);
    model_tangent(&unit->state, d);
}
