/* A pin on a turning disc, in C, as an engine for friction-discs: one line of JSON in, one out.
       cc -std=c99 -O2 -o exec_pin exec_pin.c -lm
       friction-discs report trajectories --engine "exec:./exec_pin"
   Solves eq. 1 with Shampine's Rosenbrock method of order 4(3), ACM Trans. Math. Softw. 8 (1982) 93. Friction at slip s
   is -load*s/r*(2 - |s|/r), r = max(|s|, eps). eps and the error per step decrease with the tolerance. The error per
   step is far smaller than eps, because a step into stick must end well inside eps. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double mass, stiffness, damping, load, omega, offset, eps, length, speed, accuracy;

static char *after(char *line, const char *key) { return strchr(strstr(line, key) + strlen(key), ':') + 1; }
static double number(char *line, const char *key) { return strtod(after(line, key), NULL); }

static void rates(const double y[4], double f[4]) {
    double sx = y[2] + omega * y[1], sy = y[3] - omega * y[0], s = hypot(sx, sy), r = fmax(s, eps);
    double hold = load * (2 - s / r) / r;
    f[0] = y[2], f[1] = y[3], f[2] = (-hold * sx - stiffness * (y[0] - offset) - damping * y[2]) / mass;
    f[3] = (-hold * sy - stiffness * y[1] - damping * y[3]) / mass;
}

/* Tries a step h from y, writes its end, and returns its error relative to the allowed error. */
static double step(const double y[4], double h, double end[4]) {
    static const double D[4][3] = {{0}, {-8}, {14.88, 2.4}, {-.896, -.432, -.4}}, A[3][2] = {{0}, {2}, {1.92, .24}};
    static const double B[4] = {19 / 9., .5, 25 / 108., 125 / 108.}, E[4] = {17 / 54., 7 / 36., 0, 125 / 108.};
    double sx = y[2] + omega * y[1], sy = y[3] - omega * y[0], s = hypot(sx, sy) + 1e-99, r = fmax(s, eps);
    double hold = load * (2 - s / r) / r, bend = load / (r * r * s), a = 2 / h, M[4], f[4], at[4], g[4][4], error = 0;
    double H[3] = {hold - bend * sx * sx, -bend * sx * sy, hold - bend * sy * sy}; /* -dF/ds: xx, xy, yy */
    double V[4] = {-H[0] - damping, -H[1], -H[1], -H[2] - damping}; /* V, P: derivatives of the force by velocity and position */
    double P[4] = {H[1] * omega - stiffness, -H[0] * omega, H[2] * omega, -H[1] * omega - stiffness};
    for (int i = 0; i < 4; i++) P[i] /= mass, M[i] = (i % 3 ? 0 : a) - V[i] / mass - P[i] / a;
    for (int k = 0; k < 4; k++) {
        memcpy(at, y, sizeof at);
        for (int j = 0; j < k && j < 2; j++)
            for (int i = 0; i < 4; i++) at[i] += A[k < 3 ? k : 2][j] * g[j][i];
        rates(at, f);
        for (int j = 0; j < k; j++)
            for (int i = 0; i < 4; i++) f[i] += D[k][j] * g[j][i] / h;
        double rx = f[2] + (P[0] * f[0] + P[1] * f[1]) / a, ry = f[3] + (P[2] * f[0] + P[3] * f[1]) / a;
        double determinant = M[0] * M[3] - M[1] * M[2];
        g[k][2] = (M[3] * rx - M[1] * ry) / determinant, g[k][3] = (M[0] * ry - M[2] * rx) / determinant;
        g[k][0] = (f[0] + g[k][2]) / a, g[k][1] = (f[1] + g[k][3]) / a;
    }
    for (int i = 0; i < 4; i++) {
        double off = E[0] * g[0][i] + E[1] * g[1][i] + E[2] * g[2][i] + E[3] * g[3][i];
        end[i] = y[i] + B[0] * g[0][i] + B[1] * g[1][i] + B[2] * g[2][i] + B[3] * g[3][i];
        error = fmax(error, fabs(off) / (accuracy * (i < 2 ? length : speed)));
    }
    return error;
}

int main(void) {
    size_t size = 1 << 16, used = 0; char *line = malloc(size);
    puts("{\"protocol\":1,\"name\":\"exec_pin\",\"version\":\"1\",\"kinds\":[\"pin\"],\"nonlinear\":false}");
    for (fflush(stdout); fgets(line + used, size - used, stdin); fflush(stdout)) {
        used += strlen(line + used);
        if (line[used - 1] != '\n') { line = realloc(line, size *= 2); continue; } /* the line continues */
        mass = number(line, "\"mass\""), stiffness = number(line, "\"stiffness\""), used = 0;
        damping = number(line, "\"damping\""), load = number(line, "\"friction_force\"");
        omega = number(line, "\"disc_speed\""), offset = number(line, "\"offset\"");
        double y[4], end[4], tolerance = number(line, "\"tolerance\""), natural = sqrt(stiffness / mass), h, t;
        char *next = after(line, "\"state\""), *times = after(line, "\"times\"");
        for (int i = 0; i < 4; i++) y[i] = strtod(next + 1, &next); /* after the bracket or comma */
        length = hypot(y[0], y[1]) + fabs(offset) + (natural > 0 ? hypot(y[2], y[3]) / natural : 0) + 1e-9;
        speed = hypot(y[2], y[3]) + (fabs(omega) + natural) * length;
        eps = tolerance * speed, accuracy = tolerance / 1e4, h = 1e-3 * length / speed;
        t = strtod(times + 1, NULL), printf("{\"states\":");
        for (char mark = '['; *times != ']'; mark = ',') {
            for (double to = strtod(times + 1, &times); t < to;) {
                double tried = fmin(h, to - t), least = 1e-15 * (fabs(to) + length / speed), error = step(y, tried, end);
                if (error <= 1 || tried < least) memcpy(y, end, sizeof y), t = tried < to - t ? t + tried : to;
                if (error > 1 || tried == h) h = tried * fmin(3, fmax(.2, .9 * pow(error, -.25)));
            }
            printf("%c[%.17g,%.17g,%.17g,%.17g]", mark, y[0], y[1], y[2], y[3]);
        }
        puts("]}");
    }
}
