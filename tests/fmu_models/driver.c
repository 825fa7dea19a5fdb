/* What tests call of a unit without a standard around it. */
#include "unit.h"
#include <stdlib.h>
#include <string.h>

#define MOST_EVENTS 64

typedef struct {
    Unit unit;
    char said[INTERNAL_DIGITS];
    int events, steps;
    double times[MOST_EVENTS];
    double modes[MOST_EVENTS];
} Driver;

static void say(Unit *unit, int failed, const char *sentence) {
    (void)failed;
    strncpy(((Driver *)unit)->said, sentence, INTERNAL_DIGITS - 1);
}

static int between(Unit *unit, double time) {
    Driver *driver = (Driver *)unit;
    int last = driver->events ? (int)driver->modes[driver->events - 1] : SLIPS;
    driver->steps++;
    if (unit->state.mode != last && driver->events < MOST_EVENTS) {
        driver->times[driver->events] = time;
        driver->modes[driver->events++] = unit->state.mode;
    }
    return 0;
}

Driver *made(void) {
    Driver *driver = calloc(1, sizeof(Driver));
    driver->unit.say = say;
    driver->unit.between = between;
    unit_reset(&driver->unit);
    return driver;
}

const char *said(Driver *driver) { return driver->said; }
int steps(Driver *driver) { return driver->steps; }

int events(Driver *driver, double times[], double modes[]) {
    memcpy(times, driver->times, driver->events * sizeof(double));
    memcpy(modes, driver->modes, driver->events * sizeof(double));
    return driver->events;
}

double get(Driver *driver, int variable) { return unit_get(&driver->unit, variable); }
int set(Driver *driver, int variable, double value) {
    return unit_set(&driver->unit, variable, VARIABLES[variable].type, value);
}
int initialise(Driver *driver, double time) { return unit_initialise(&driver->unit, time); }
int advance(Driver *driver, double until) { return unit_advance(&driver->unit, until); }

/* As a solver of an importer sets them. */
void put_states(Driver *driver, const double x[]) {
    for (int i = 0; i < N_STATES; i++) driver->unit.state.v[STATES[i]] = x[i];
    driver->unit.state.stale = 1;
}

void tangent(Driver *driver, double d[]) { unit_tangent(&driver->unit, d); }
int mode(Driver *driver) { return driver->unit.state.mode; }
