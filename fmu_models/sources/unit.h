/* One instance of a model, whatever the version of the standard that it is asked by. */
#ifndef UNIT_H
#define UNIT_H
#include "variables.h"

#define INTERNAL_DIGITS 256

/* All that moves: what is rolled back. */
typedef struct {
    double v[N_VARIABLES]; /* by value reference */
    double epsilon;        /* of the contact in m/s */
    double nominal[N_STATES + 1];
    double step;       /* with which the integrator goes on, in s */
    double longest;    /* of its steps, in s */
    double tolerance;  /* of the integrator */
    double leaving;    /* slip speed in m/s from which on the direction of friction is that of the slip again */
    double slowest;    /* slip speed in m/s of the contact, of its slowest point if it has single ones */
    double left_time;      /* when single points that rest exceeded epsilon, in s, unless they came back below it */
    double left[N_STATES]; /* and the states then */
    int leaves;            /* whether that is so */
    int held_up;       /* steps in a row, by and large, that an explicit method can't take longer */
    int mode;          /* of the contact; but SLIPS of an exact one only */
    int stale;         /* whether what follows from states and inputs is to be found yet */
    int exact;         /* whether the contact sticks by events */
    int initialised;
} State;

/* STICKS: it rests as a whole. LEAVES: it was let go, and is so slow that friction turns faster than steps can follow;
   its direction is then that of what would hold the contact, which the slip follows but for the square of the time. */
enum { SLIPS, STICKS, LEAVES };

typedef struct Unit Unit;

struct Unit {
    State state;
    char name[INTERNAL_DIGITS];
    void (*say)(Unit *unit, int failed, const char *sentence); /* through the logger of the importer */
    void (*logger)(void);
    void *environment;
    int logging;
    /* Called after each step of the integrator; returns whether the importer wants to stop there. */
    int (*between)(Unit *unit, double time);
    void (*update)(void);
    int early;
    int exchange; /* whether the solver is the importer's */
};

/* What a model is: pin.c, disc.c and clutch.c each define these. */
int model_exact(const double v[]);           /* whether the contact sticks by events, or creeps */
/* The size of what moves, in m and m/s, and its rate in 1/s, 0 where inputs may have any. Returns the share of that size
   by which errors of small states are measured. */
double model_scales(const State *state, double *length, double *speed, double *rate);
void model_evaluate(State *state); /* derivatives and outputs from states and inputs */
void model_tangent(const State *state, double d[]); /* their derivatives along those of states and inputs in d */
/* The states at a time t in s of what rests, in closed form; returns 0, and has none, for what moves. */
int model_carried(const State *state, double t, double x[N_STATES]);
/* How many single points are slower than a factor times epsilon; of models with the variable resting_points. */
int model_resting(const State *state, double factor);
int model_change(State *state); /* begins to stick or to slip if that is due; returns whether it did */

void unit_reset(Unit *unit);
int unit_initialise(Unit *unit, double time); /* 0, or 1 if parameters break a rule */
void unit_refresh(Unit *unit);
double unit_get(Unit *unit, size_t variable);
int unit_set(Unit *unit, size_t variable, char type, double value); /* 0, or 1 if the value was refused */
int unit_has(Unit *unit, size_t variable, char type);
void unit_tangent(Unit *unit, double d[N_VARIABLES]);
int unit_advance(Unit *unit, double until); /* by co-simulation; 0, 1 if it failed, 2 if it stopped early */

#endif
