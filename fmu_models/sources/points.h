/* Dry friction of a disc on single points, each of them viscous near its own rest. */
#ifndef POINTS_H
#define POINTS_H

typedef struct {
    int points;
    double radius;   /* on which they are, in m */
    double friction; /* mu N of all of them in N */
    double epsilon;  /* slip speed of a point in m/s below which it is viscous */
} Points;

/* Fx, Fy in N and M in N m on a disc that has turned by an angle in rad, whose centre slips with slip[0..1] in m/s and
   which turns with slip[2] in rad/s over what it touches. Returns the mean slip speed in m/s, and
   that of the slowest point. */
double points_friction(const Points *contact, double angle, const double slip[3], double force[3], double *least);

/* The derivative of that along d_angle and the direction d of the slip. Returns that of the mean slip speed. */
double points_tangent(const Points *contact, double angle, double d_angle, const double slip[3], const double d[3],
                      double d_force[3]);

#endif
