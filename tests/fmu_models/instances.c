/* Many instances in turn, for a sanitizer: COUNT clutches, each with its own parameters and inputs, STEPS in all. */
#include "unit.h"
#include <stdio.h>
#include <stdlib.h>

static void say(Unit *unit, int failed, const char *sentence) {
    (void)unit, (void)failed;
    puts(sentence);
}

int main(int count, char **arguments) {
    int instances = count > 1 ? atoi(arguments[1]) : 10, steps = count > 2 ? atoi(arguments[2]) : 100;
    Unit **units = malloc(instances * sizeof(Unit *));
    double sum = 0.0;
    for (int i = 0; i < instances; i++) {
        units[i] = calloc(1, sizeof(Unit));
        units[i]->say = say;
        unit_reset(units[i]);
        unit_set(units[i], V_inner_radius, 'r', i % 2 ? 0.1 : 0.08);
        if (i % 4 == 1) unit_set(units[i], V_contact_points, 'n', 3 + i % 5);
        unit_set(units[i], V_pressure_mean, 'r', 1.0 + 0.1 * (i % 4));
        unit_set(units[i], V_regularisation, 'r', 1e-3);
        unit_set(units[i], V_static_ratio, 'r', 1.0 + 0.1 * (i % 3));
        unit_set(units[i], V_mass, 'r', 1.0 + i);
        unit_set(units[i], V_stiffness, 'r', 1e4);
        unit_set(units[i], V_tolerance, 'r', 1e-4);
        if (unit_initialise(units[i], 0.0)) return 1;
    }
    for (int step = 0; step < steps; step++) {
        Unit *unit = units[step % instances];
        double d[N_VARIABLES] = {0.0}, until = 1e-4 * (1 + step / instances);
        State kept = unit->state;
        unit_set(unit, V_speed_a, 'r', 30.0 - 1e-3 * (step / instances));
        unit_set(unit, V_speed_b, 'r', step % 7 ? 0.0 : 30.0);
        if (unit_advance(unit, until)) return 1;
        unit->state = kept;
        if (unit_advance(unit, until)) return 1;
        d[V_speed_a] = 1.0;
        unit_tangent(unit, d);
        sum += unit_get(unit, V_torque_b) + d[V_torque_b];
    }
    for (int i = 0; i < instances; i++) free(units[i]);
    free(units);
    printf("%g\n", sum);
    return 0;
}
