"""Small robots as URDF and MJCF texts, for tests of the import."""

FOOT = 0.02
QUADRUPED = {"FL": (1, 1), "FR": (1, -1), "RL": (-1, 1), "RR": (-1, -1)}


GYRATION = 0.04  # m; as if the mass of a link lay so far from its centre


def link(name, mass=0.1, shape="", at="0 0 0"):
    moment = GYRATION**2 * mass if isinstance(mass, float) else 0.01
    inertial = (
        f'<inertial><origin xyz="{at}"/><mass value="{mass}"/>'
        f'<inertia ixx="{moment}" iyy="{moment}" izz="{moment}" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    return f'<link name="{name}">{inertial if mass else ""}{shape}</link>'


def shape(geometry, at="0 0 0"):
    return f'<collision><origin xyz="{at}"/><geometry>{geometry}</geometry></collision>'


def joint(name, parent, child, at, axis, kind="revolute", low=-1.0, high=1.0, effort=30.0):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{at[0]!r} {at[1]!r} {at[2]!r}"/><axis xyz="{axis}"/>'
        f'<limit lower="{low}" upper="{high}" effort="{effort}" velocity="15"/></joint>'
    )


def urdf(*parts):
    return f'<robot name="it">{"".join(parts)}</robot>'


def quadruped(turn=lambda x, y: (x, y), axes=("1 0 0", "0 1 0"), legs=QUADRUPED):
    """Return a quadruped as those of today: abduction, hip, knee, legs that hang down; ``turn`` moves points."""

    def at(x, y, z):
        return (*turn(x, y), z)

    parts = [
        link("base", 8.0, shape('<box size="0.4 0.18 0.12"/>' if turn(1, 0) == (1, 0) else '<sphere radius="0.09"/>'))
    ]
    for leg, (x, y) in legs.items():
        parts += [
            link(f"{leg}_hip", 0.7),
            link(f"{leg}_thigh", 1.0, shape('<cylinder radius="0.02" length="0.2"/>', "0 0 -0.1"), "0 0 -0.1"),
            link(f"{leg}_calf", 0.2, shape('<cylinder radius="0.015" length="0.2"/>', "0 0 -0.1"), "0 0 -0.1"),
            link(f"{leg}_foot", 0.05, shape(f'<sphere radius="{FOOT}"/>')),
            joint(f"{leg}_abduction", "base", f"{leg}_hip", at(0.19 * x, 0.05 * y, 0.0), axes[0], low=-0.86, high=0.86),
            joint(f"{leg}_swing", f"{leg}_hip", f"{leg}_thigh", at(0.0, 0.08 * y, 0.0), axes[1], low=-0.7, high=3.2),
            joint(f"{leg}_knee", f"{leg}_thigh", f"{leg}_calf", (0.0, 0.0, -0.21), axes[1], low=-2.7, high=-0.9),
            joint(f"{leg}_fixed", f"{leg}_calf", f"{leg}_foot", (0.0, 0.0, -0.21), "1 0 0", kind="fixed"),
        ]
    return urdf(*parts)


def pendulum(count=4, length=0.2, axis="0 0 1"):
    """Return a chain of equal rods behind each other, from the head backward."""
    rod = shape(f'<sphere radius="{0.1 * length}"/>', f"{-length / 2!r} 0 0")
    parts = [link(f"rod_{i}", 0.5, rod, f"{-length / 2!r} 0 0") for i in range(count)]
    parts += [
        joint(f"hinge_{i}", f"rod_{i - 1}", f"rod_{i}", (-length, 0.0, 0.0), axis, low=-0.5 * i, high=0.25 * i)
        for i in range(1, count)
    ]
    return urdf(*parts)


def skewed(angle="0.7853981633974483"):
    """Return an MJCF of a body with four legs that point out between its axes, as an ant's."""
    legs = "".join(
        f'<body name="{name}" pos="{0.2 * x} {0.2 * y} 0"><joint name="{name}_hip" axis="0 0 1" range="-1.2 1.2"/>'
        f'<geom type="capsule" size="0.02" fromto="0 0 0 {0.1 * x} {0.1 * y} 0"/>'
        f'<body name="{name}_shin" pos="{0.1 * x} {0.1 * y} 0">'
        f'<joint name="{name}_lift" axis="{-y} {x} 0" range="-0.5 1.2"/>'
        f'<geom type="capsule" size="0.015" fromto="0 0 0 {0.05 * x} {0.05 * y} 0"/>'
        f'<body name="{name}_toe" pos="{0.05 * x} {0.05 * y} 0">'
        f'<joint name="{name}_knee" axis="{-y} {x} 0" range="-0.2 2"/>'
        f'<geom type="capsule" size="0.015" fromto="0 0 0 {0.1 * x} {0.1 * y} 0"/></body></body></body>'
        for name, (x, y) in {"LF": (1, 1), "RF": (1, -1), "LH": (-1, 1), "RH": (-1, -1)}.items()
    )
    return (
        '<mujoco><compiler angle="radian"/><worldbody><body name="trunk"><freejoint/>'
        f'<geom type="ellipsoid" size="0.3 0.12 0.05" mass="2"/>{legs}</body></worldbody></mujoco>'
    )
