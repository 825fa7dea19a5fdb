"""C header and tables of a model: its variables, and the quadrature rule for an annulus."""

import re

import numpy as np

from fmu_models.variables import Model, Variable

RINGS = 12
"""Number of quadrature points of an annulus, on each side of the radius at which a point may be at rest."""

CAUSALITY = {
    "time": "t",
    "parameter": "p",
    "state": "s",
    "derivative": "d",
    "input": "i",
    "output": "o",
    "local": "d",
    "event": "o",
}
TYPE = {"real": "r", "whole": "n", "boolean": "b"}
BROKEN = "int broken_rule(const double v[], char *sentence, size_t size)"


def header(model: Model, token: str) -> str:
    """Return the text of ``variables.h``; ``token`` must agree with the description."""
    return "\n".join(
        [
            "/* Generated from the table of variables: the value reference of each. */",
            "#ifndef VARIABLES_H",
            "#define VARIABLES_H",
            "#include <stddef.h>",
            *(f"#define V_{one.name} {i}" for i, one in enumerate(model.variables)),
            f"#define N_VARIABLES {len(model.variables)}",
            f"#define N_STATES {len(model.states)}",
            f"#define N_GAUSS {RINGS}",
            f'#define TOKEN "{token}"',
            "typedef struct {",
            "    const char *name, *unit;",
            "    char type, causality;",
            "    double start, least, most;",
            "} Variable;",
            *(f"extern const {array};" for array in _arrays(model)),
            "/* Returns whether parameters violate a rule, and its message in sentence. */",
            f"{BROKEN};",
            "#endif",
            "",
        ]
    )


def tables(model: Model) -> str:
    """Return the text of ``variables.c``, which defines the names declared by the header."""
    lines = [f"const {array} = {{{values}}};" for array, values in _arrays(model).items()]
    return "\n".join(
        ['#include "variables.h"', "#include <math.h>", "#include <stdio.h>", *lines, _rules(model), ""]
    )


def _rules(model: Model) -> str:
    values = {one.name: f"v[V_{one.name}]" for one in model.having("parameter")}
    lines = [f"{BROKEN} {{", "    (void)v, (void)sentence, (void)size;"]
    for condition, sentence in model.rules:
        in_c = re.sub(r"[a-z_]+", lambda word: values.get(word[0], word[0]), condition)
        used = "".join(f", {values[name]}" for name in re.findall(r"{(\w+):g}", sentence))
        said = re.sub(r"{\w+:g}", "%g", sentence)
        lines += [f"    if (!({in_c}))", f'        return snprintf(sentence, size, "{said}"{used});']
    return "\n".join([*lines, "    return 0;", "}"])


def _arrays(model: Model) -> dict[str, str]:
    places, weights = np.polynomial.legendre.leggauss(RINGS)
    return {
        "Variable VARIABLES[N_VARIABLES]": ",\n".join(_row(one) for one in model.variables),
        "int STATES[N_STATES]": ", ".join(f"V_{one.name}" for one in model.states),
        "int DERIVATIVES[N_STATES]": ", ".join(f"V_{one.name}" for one in model.derivatives),
        "char STATE_KINDS[N_STATES]": ", ".join(repr(one.scale) for one in model.states),
        "double GAUSS_PLACES[N_GAUSS]": _numbers(0.5 + 0.5 * places),
        "double GAUSS_WEIGHTS[N_GAUSS]": _numbers(0.5 * weights),
    }


def _numbers(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> str:
    return ", ".join(repr(float(value)) for value in values)


def _row(one: Variable) -> str:
    start = 0.0 if one.start is None else one.start
    numbers = ", ".join(repr(float(value)) for value in (start, one.least, one.most))
    return f'{{"{one.name}", "{one.unit}", {TYPE[one.type]!r}, {CAUSALITY[one.role]!r}, {numbers}}}'
