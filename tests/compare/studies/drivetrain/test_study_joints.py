"""Recorded engines in the study of joints."""

from compare.studies.drivetrain.joints.study import STUDY


def test_the_table_of_recorded_engines_has_their_verdicts_in_words():
    (table,) = STUDY.tables()
    assert table.header[1:3] == ("stops", "holds")
    rows = {row[0]: row[1:] for row in table.rows}
    foreign = {
        "MuJoCo",
        "Bullet",
        "Drake",
        "DART",
        "ODE",
        "Chipmunk",
        "Box2D",
        "Rapier",
        "Jolt",
        "PhysX",
        "Havok",
    }
    assert foreign <= {name.partition(",")[0] for name in rows}
    marks = {name: "".join(cell[0] for cell in row[:-1]) for name, row in rows.items()}
    assert marks["Bullet, cone"] == marks["DART, NSGS"] == marks["ODE, along the slip"] == "✓✓n✓✓"
    assert marks["MuJoCo, as shipped"] == "✓✗n✗✗"
    assert (
        "creeps at 0.0011 rad/s under half of the limit F, independent of the step"
        in rows["MuJoCo, as shipped"][-1]
    )
    assert rows["MuJoCo, as shipped"][2] == "not simulated"
