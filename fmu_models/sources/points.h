/* The slip of single points of a contact. */
#ifndef POINTS_H
#define POINTS_H
#include "contact.h"

/* The mean over the points of the direction of their slip, shorter than 1 where one is slower than epsilon: along x, y,
   and about the centre in m. Friction is that times -mu N. Returns their mean speed, and that of the slowest, in m/s. */
double points_slip(const Contact *contact, const double slip[3], double mean[3], double *slowest);

/* How many points are slower than epsilon: 0, 1, or all of them, as where two of a rigid body rest. */
int points_at_rest(const Contact *contact, const double slip[3]);

/* The derivative of points_slip along the direction d of the slip and d_angle of the angle. Returns that of the mean speed. */
double points_slip_tangent(const Contact *contact, const double slip[3], const double d[3], double d_angle,
                           double d_mean[3]);

#endif
