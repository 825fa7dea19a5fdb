/* One instance of a model, independent of the version of the standard. */
#ifndef UNIT_H
#define UNIT_H
#include "variables.h"

#define INTERNAL_DIGITS 256

/* The complete state of an instance, which importers may save and restore. */
typedef struct {
    double v[N_VARIABLES]; /* by value reference */
    double epsilon;        /* regularisation speed of the contact in m/s */
    double nominal[N_STATES + 1];
    double step;       /* next step of the integrator in s */
    double longest;    /* longest step of the integrator in s */
    double tolerance;  /* tolerance of the integrator */
    double leaving;    /* slip speed in m/s above which friction after a release opposes the slip again */
    double slowest;    /* slip speed in m/s of the contact, or of its slowest point */
    double left_time;      /* time in s when resting points last exceeded epsilon */
    double left[N_STATES]; /* the states at that time */
    int leaves;            /* 1 from then until their release is certain, or they fall below epsilon again */
    int held_up;       /* count of successive explicit steps at the stability limit */
    int mode;          /* mode of an exact contact; otherwise SLIPS */
    int stale;         /* 1 if derivatives and outputs must be evaluated again */
    int exact;         /* 1 if the contact sticks by events */
    int initialised;
} State;

/* STICKS: the contact rests as a whole. LEAVES: it has been released, but its slip is so slow that the direction of
   friction changes faster than steps resolve. Friction then has the direction of the holding force, which the slip follows
   up to an error of second order in time. */
enum { SLIPS, STICKS, LEAVES };

typedef struct Unit Unit;

struct Unit {
    State state;
    char name[INTERNAL_DIGITS];
    void (*say)(Unit *unit, int failed, const char *sentence); /* calls the importer's logger */
    void (*logger)(void);
    void *environment;
    int logging;
    /* Called after each step of the integrator; returns whether to stop there. */
    int (*between)(Unit *unit, double time);
    void (*update)(void);
    int early;
    int exchange; /* 1 for model exchange, with the importer's solver */
};

/* The functions of a model, defined by supported.c (pin and disc) and clutch.c. */
int model_exact(const double v[]); /* 1 if the contact sticks by events, 0 if it creeps */
/* Length (m) and speed (m/s) of the motion, and its rate (1/s), 0 if inputs may have any rate. Returns the share of these
   sizes that scales the errors of small states. */
double model_scales(const State *state, double *length, double *speed, double *rate);
void model_evaluate(State *state); /* computes derivatives and outputs from states and inputs */
void model_tangent(const State *state, double d[]); /* extends changes d of states and inputs to all variables */
/* States of a sticking contact at the time t in s, in closed form; returns 0 if it does not stick. */
int model_carried(const State *state, double t, double x[N_STATES]);
/* Number of points slower than factor times epsilon, for models with the variable resting_points. */
int model_resting(const State *state, double factor);
int model_change(State *state); /* changes between stick and slip if due; returns whether it did */

void unit_reset(Unit *unit);
int unit_initialise(Unit *unit, double time); /* 0, or 1 if parameters violate a rule */
void unit_refresh(Unit *unit);
double unit_get(Unit *unit, size_t variable);
int unit_set(Unit *unit, size_t variable, char type, double value); /* 0, or 1 if the value is not allowed */
int unit_has(Unit *unit, size_t variable, char type);
void unit_tangent(Unit *unit, double d[N_VARIABLES]);
int unit_advance(Unit *unit, double until); /* in co-simulation; 0, 1 if it failed, 2 if it stopped early */

#endif
