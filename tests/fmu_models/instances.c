/* Many instances in turn, for a sanitizer: clutches, each with its own parameters and inputs. */
#include "unit.h"
#include <stdio.h>
#include <stdlib.h>

#define INSTANCES 300
#define STEPS 900

static void say(Unit *unit, int failed, const char *sentence) {
    (void)unit, (void)failed;
    puts(sentence);
}

int main(void) {
    Unit *units = calloc(INSTANCES, sizeof(Unit));
    double sum = 0.0;
    for (int i = 0; i < INSTANCES; i++) {
        Unit *unit = &units[i];
        unit->say = say;
        unit_reset(unit);
        unit_set(unit, V_inner_radius, 'r', i % 2 ? 0.1 : 0.08);
        if (i % 4 == 1) unit_set(unit, V_contact_points, 'n', 3 + i % 5);
        unit_set(unit, V_regularisation, 'r', 1e-3);
        unit_set(unit, V_mass, 'r', 1.0 + i);
        unit_set(unit, V_tolerance, 'r', 1e-4);
        if (unit_initialise(unit, 0.0)) return 1;
    }
    for (int step = 0; step < STEPS; step++) {
        Unit *unit = &units[step % INSTANCES];
        double d[N_VARIABLES] = {0.0};
        unit_set(unit, V_speed_a, 'r', 30.0);
        unit_set(unit, V_speed_b, 'r', step % 7 ? 0.0 : 30.0);
        if (unit_advance(unit, 1e-4 * (1 + step / INSTANCES))) return 1;
        d[V_speed_a] = 1.0;
        unit_tangent(unit, d);
        sum += unit_get(unit, V_torque_b) + d[V_torque_b];
    }
    free(units);
    printf("%g\n", sum);
    return 0;
}
