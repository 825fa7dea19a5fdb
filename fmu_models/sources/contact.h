/* Dry friction of a pin, points, a ring or an annulus: gradient of a slip potential, regularised near rest. */
#ifndef CONTACT_H
#define CONTACT_H

typedef struct {
    double inner, outer; /* radii in m: equal for a ring, both 0 for a pin */
    int points;          /* number of single points on the outer radius, 0 for a continuous contact */
    double angle;        /* angle of the first point in rad */
    int wear;            /* base pressure of an annulus: proportional to 1/r (even wear), or uniform */
    double pressure[3];  /* factor on it, a parabola with these values at the inner, mean and outer radius */
    double friction;     /* mu N of all plates in sliding, in N */
    double static_ratio; /* static over sliding friction */
    double epsilon;      /* slip speed in m/s below which friction is viscous: mean speed, or that of each point */
} Contact;

/* dP/dU and dP/dW of a ring; its centre slips at U, its rim turns at W, both >= 0 and not both 0. */
void ring_slopes(double U, double W, double slope[2]);

/* d2P/dU2, d2P/dUdW, d2P/dW2. */
void ring_curvatures(double U, double W, double curvature[3]);

/* Returns the mean slip speed P in m/s of a pin, ring or annulus, and its slopes by U and |S| (m), or 0 at rest. */
double slip_potential(const Contact *contact, double U, double S, double slope[2]);

/* Fx, Fy in N and M in N m on a disc with slip velocity slip[0..1] of its centre in m/s and relative spin slip[2] in
   rad/s. Returns P; slowest is the slip speed of the slowest point, or P without points. */
double friction(const Contact *contact, const double slip[3], double force[3], double *slowest);

/* Derivative of the force along a change d of the slip; at rest, the one-sided derivative towards d. Returns that of P.
   d_friction and d_angle are the changes of mu N and of the angle. */
double friction_tangent(const Contact *contact, const double slip[3], const double d[3], double d_friction,
                        double d_angle, double d_force[3]);

/* Returns the least mu N in N that holds a pin, ring or annulus at rest against a force (N) and a moment (N m), and its
   derivatives by both. */
double friction_needed(const Contact *contact, double force, double moment, double by[2]);

#endif
