/* A pin that slides, as a model for co-simulation by FMI 2 or, with -DFMI=3, by FMI 3.
   By FMI 2 a communication step is one of Runge and Kutta; by FMI 3 steps of its own go with the tolerance.
   -DMISTAKE=2 counts the damping twice. Only what a master calls is there. */
#include <math.h>
#include <stdlib.h>
#ifndef FMI
#define FMI 2
#endif
#ifndef MISTAKE
#define MISTAKE 1
#endif
#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT
#endif

enum { MASS, STIFFNESS, DAMPING, LOAD, SPEED, OFFSET, X, Y, VX, VY, COUNT };
typedef struct { double value[COUNT], longest; } Pin;
enum { OK, ERROR = 3 };

static void rates(const double *p, const double *y, double *f) {
    double sx = y[2] + p[SPEED] * y[1], sy = y[3] - p[SPEED] * y[0], hold = p[LOAD] / hypot(sx, sy);
    f[0] = y[2], f[1] = y[3];
    f[2] = (-hold * sx - p[STIFFNESS] * (y[0] - p[OFFSET]) - MISTAKE * p[DAMPING] * y[2]) / p[MASS];
    f[3] = (-hold * sy - p[STIFFNESS] * y[1] - MISTAKE * p[DAMPING] * y[3]) / p[MASS];
}

static void step(Pin *pin, double h) {
    static const double share[4] = {0, .5, .5, 1}, weight[4] = {1, 2, 2, 1};
    double *y = pin->value + X, k[4] = {0}, sum[4] = {0}, at[4];
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) at[j] = y[j] + share[i] * h * k[j];
        rates(pin->value, at, k);
        for (int j = 0; j < 4; j++) sum[j] += weight[i] * k[j];
    }
    for (int j = 0; j < 4; j++) y[j] += h * sum[j] / 6;
}

static int advance(Pin *pin, double h) {
    int count = (int)fmax(1, ceil(h / pin->longest));
    for (int i = 0; i < count; i++) step(pin, h / count);
    return pin->value[MASS] > 100 ? ERROR : OK; /* for a test: it is too heavy */
}

static int set(Pin *pin, const unsigned *at, size_t n, const double *from) {
    for (size_t i = 0; i < n; i++) pin->value[at[i]] = from[i];
    return OK;
}

static int get(Pin *pin, const unsigned *at, size_t n, double *to) {
    for (size_t i = 0; i < n; i++) to[i] = pin->value[at[i]];
    return OK;
}

static Pin *made(void) {
    Pin *pin = calloc(1, sizeof(Pin));
    pin->longest = INFINITY;
    return pin;
}

#if FMI == 2
EXPORT void *fmi2Instantiate(const char *a, int b, const char *c, const char *d, const void *e, int f, int g) {
    (void)a, (void)b, (void)c, (void)d, (void)e, (void)f, (void)g;
    return made();
}
EXPORT void fmi2FreeInstance(void *pin) { free(pin); }
EXPORT int fmi2SetupExperiment(void *pin, int a, double tolerance, double start, int b, double stop) {
    (void)pin, (void)a, (void)tolerance, (void)start, (void)b, (void)stop;
    return OK;
}
EXPORT int fmi2EnterInitializationMode(void *pin) { return pin ? OK : ERROR; }
EXPORT int fmi2ExitInitializationMode(void *pin) { return pin ? OK : ERROR; }
EXPORT int fmi2Terminate(void *pin) { return pin ? OK : ERROR; }
EXPORT int fmi2SetReal(void *pin, const unsigned *at, size_t n, const double *from) { return set(pin, at, n, from); }
EXPORT int fmi2GetReal(void *pin, const unsigned *at, size_t n, double *to) { return get(pin, at, n, to); }
EXPORT int fmi2DoStep(void *pin, double at, double h, int a) {
    (void)at, (void)a;
    return advance(pin, h);
}
#else
#include <stdbool.h>
EXPORT void *fmi3InstantiateCoSimulation(const char *a, const char *b, const char *c, bool d, bool e, bool f, bool g,
                                         const unsigned *h, size_t i, void *j, void *k, void *l) {
    (void)a, (void)b, (void)c, (void)d, (void)e, (void)f, (void)g, (void)h, (void)i, (void)j, (void)k, (void)l;
    return made();
}
EXPORT void fmi3FreeInstance(void *pin) { free(pin); }
EXPORT int fmi3EnterInitializationMode(void *pin, bool a, double tolerance, double start, bool b, double stop) {
    (void)a, (void)start, (void)b, (void)stop;
    ((Pin *)pin)->longest = 2e-3 * sqrt(tolerance / 1e-9);
    return OK;
}
EXPORT int fmi3ExitInitializationMode(void *pin) { return pin ? OK : ERROR; }
EXPORT int fmi3Terminate(void *pin) { return pin ? OK : ERROR; }
EXPORT int fmi3SetFloat64(void *pin, const unsigned *at, size_t n, const double *from, size_t m) {
    return n == m ? set(pin, at, n, from) : ERROR;
}
EXPORT int fmi3GetFloat64(void *pin, const unsigned *at, size_t n, double *to, size_t m) {
    return n == m ? get(pin, at, n, to) : ERROR;
}
EXPORT int fmi3DoStep(void *pin, double at, double h, bool a, bool *event, bool *end, bool *early, double *last) {
    (void)a;
    *event = *end = *early = false, *last = at + h;
    return advance(pin, h);
}
#endif
