"""USD with the physics schema: rigid bodies, revolute joints with limits and drives, shapes, frames."""

from typing import Any, NamedTuple

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from suchus.core.errors import SuchusError
from suchus.robot.design import GRAVITY, Robot, layout
from suchus.robot.motion import Gait
from suchus.sim.model.build import IMU, compile_model, sites, standing
from suchus.sim.model.export.mjcf import home
from suchus.sim.model.export.urdf import ball, fill_texts

LINK_MASS, LINK_INERTIA = 1e-6, 1e-9
"""Of the link between two joints in one point [kg], [kg m2]: in USD a mass of zero means that it is not known."""
UNSAID = (
    "The cable. In the model {pulls} and a tendon bends all {cables} tail joints ({first} to {last}) "
    "at once; here each is a joint of its own. Set the targets of their drives to the bend of the tail over {cables}, "
    "and their stiffness to what your controller needs.",
    "Springs are drives with a target of zero: {springs}. The schema has no springs of their own, and does not say "
    "them from motors.",
    "Servos. A drive holds their proportional and derivative gains, torque limit and, as target, the home posture; "
    "integral gain and slew limit ({speeds} rad/s) are in robot.toml.",
    "Dry friction, damping and rotor inertia (armature) of the joints, in robot.toml.",
    "Contact: how soft it is, rolling and torsional friction, and which of two frictions counts. Sliding friction is "
    "in the two materials. Ellipsoids collide as the hull of a faceted ball.",
    "That the body does not touch itself. Links that a joint connects do not collide; switch the rest of the "
    "self-collisions off in your simulator.",
    "Joints in one point. All but the last of their links are not there in the robot; such a link has {link:g} kg and "
    "is named after the joint that carries it.",
    "Sensors. Their places are frames.",
    "More than single precision in joints, masses and inertias, whose types are floats; places of bodies and frames "
    "are doubles.",
)


class NoUsd(SuchusError, ImportError):
    """USD is asked for without the library that writes it."""


class _Link(NamedTuple):
    name: str
    place: np.ndarray
    turn: Rotation


def usd(robot: Robot, gait: Gait) -> str:
    """Return a robot as USD text, all joints at zero, the lowest part touching the ground.

    Metres, kilograms, z up; bodies lie side by side below the robot, their places in the world in full precision.

    Args:
        robot: the design.
        gait: gait whose mid-stance is the target of the drives.

    Raises:
        NoUsd: usd-core is not installed.
    """
    pxr = _library()
    model = compile_model(robot)
    data = mujoco.MjData(model)
    data.qpos[:] = standing(model, robot, 0.0, np.zeros(len(layout(robot).servos)))
    mujoco.mj_kinematics(model, data)
    stage = pxr.Usd.Stage.CreateInMemory()
    pxr.UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    pxr.UsdGeom.SetStageUpAxis(stage, pxr.UsdGeom.Tokens.z)
    pxr.UsdPhysics.SetStageKilogramsPerUnit(stage, 1.0)
    root = pxr.UsdGeom.Xform.Define(stage, f"/{prim_name(robot)}")
    stage.SetDefaultPrim(root.GetPrim())
    pxr.Usd.ModelAPI(root).SetKind("component")
    pxr.UsdPhysics.ArticulationRootAPI.Apply(root.GetPrim())
    writer = _Writer(pxr, stage, robot, model, str(root.GetPath()))
    writer.materials()
    writer.targets = dict(zip(layout(robot).servos, home(model, robot, gait)[1].tolist(), strict=True))
    for body in range(1, model.nbody):
        writer.body(body, data)
    text: str = stage.GetRootLayer().ExportToString()
    return text


def scene(robot: Robot) -> str:
    """Return a USD text with gravity, light and level ground, that refers to the robot beside it."""
    return f"""#usda 1.0
(
    defaultPrim = "World"
    kilogramsPerUnit = 1
    metersPerUnit = 1
    upAxis = "Z"
)

def Xform "World"
{{
    def PhysicsScene "physics"
    {{
        vector3f physics:gravityDirection = (0, 0, -1)
        float physics:gravityMagnitude = {GRAVITY:g}
    }}

    def DistantLight "sun"
    {{
        float inputs:intensity = 2000
        float3 xformOp:rotateXYZ = (35, 20, 0)
        uniform token[] xformOpOrder = ["xformOp:rotateXYZ"]
    }}

    def Plane "ground" (
        prepend apiSchemas = ["PhysicsCollisionAPI"]
    )
    {{
        uniform token axis = "Z"
        double length = 20
        double width = 20
        color3f[] primvars:displayColor = [(0.75, 0.75, 0.72)]
    }}

    def "{prim_name(robot)}" (
        prepend references = @./{robot.name}.usda@
    )
    {{
    }}
}}
"""


def unsaid_in_usd(robot: Robot) -> tuple[str, ...]:
    """Return what the USD of a robot leaves out, and what to do about it."""
    speeds = sorted({robot.servo(name).speed for name in layout(robot).servos})
    return fill_texts(UNSAID, robot, speeds=" or ".join(f"{v:g}" for v in speeds), link=LINK_MASS)


def prim_name(robot: Robot) -> str:
    """Return the robot's name as USD allows it: letters, digits and underscores, no digit first."""
    plain = "".join(c if c.isascii() and c.isalnum() else "_" for c in robot.name)
    return f"_{plain}" if plain[:1].isdigit() else plain


def _library() -> Any:
    """Return the library that writes USD, or raise ``NoUsd`` where it is not installed."""
    try:
        import pxr  # noqa: PLC0415  an optional extra
        from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics, UsdShade, Vt  # noqa: F401, PLC0415  they load on import
    except ImportError as error:
        raise NoUsd("USD needs usd-core; install it with: pip install 'suchus[usd]'.") from error
    return pxr


class _Writer:
    """What is being written; it fills its stage."""

    def __init__(self, pxr: Any, stage: Any, robot: Robot, model: Any, root: str) -> None:
        self.pxr, self.stage, self.robot, self.model, self.root = pxr, stage, robot, model, root
        self.targets: dict[str, float] = {}
        self.links: dict[str, _Link] = {}

    def materials(self) -> None:
        """Define what feet and skin are made of."""
        for name, friction in (("foot", self.robot.contact.foot_friction), ("skin", self.robot.contact.skin_friction)):
            material = self.pxr.UsdShade.Material.Define(self.stage, f"{self.root}/materials/{name}")
            rubbing = self.pxr.UsdPhysics.MaterialAPI.Apply(material.GetPrim())
            rubbing.CreateStaticFrictionAttr(friction)
            rubbing.CreateDynamicFrictionAttr(friction)

    def body(self, body: int, data: Any) -> None:
        """Write a body, the joints that carry it with links between them, its shapes and its frames."""
        model, name = self.model, self.model.body(body).name
        body_link = _Link(name, data.xpos[body], Rotation.from_quat(data.xquat[body], scalar_first=True))
        parent = self.links.get(model.body(int(model.body_parentid[body])).name)
        first_joint, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        hinges = [
            j for j in range(first_joint, first_joint + count) if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE
        ]
        for hinge in hinges[:-1]:
            link = body_link._replace(name=f"{model.joint(hinge).name}_link")
            self._mass(self._place(link), LINK_MASS, np.zeros(3), np.full(3, LINK_INERTIA), np.array([1.0, 0, 0, 0]))
            parent = self._joint(hinge, parent, link)
        prim = self._place(body_link)
        self._mass(prim, model.body_mass[body], model.body_ipos[body], model.body_inertia[body], model.body_iquat[body])
        if hinges:
            self._joint(hinges[-1], parent, body_link)
        elif parent is not None:
            self._fixed(parent, body_link)
        for geom in range(int(model.body_geomadr[body]), int(model.body_geomadr[body] + model.body_geomnum[body])):
            self._shape(geom, name)
        for site in (*sites(self.robot), IMU):
            site_view = model.site(site)
            if int(site_view.bodyid[0]) == body:
                frame = self.pxr.UsdGeom.Xform.Define(self.stage, f"{self.root}/{name}/{site}")
                self._move(frame, site_view.pos, site_view.quat)

    def _place(self, link: _Link) -> Any:
        """Define a rigid body at the place of a link and return its prim."""
        self.links[link.name] = link
        prim = self.pxr.UsdGeom.Xform.Define(self.stage, f"{self.root}/{link.name}")
        self._move(prim, link.place, link.turn.as_quat(scalar_first=True))
        self.pxr.UsdPhysics.RigidBodyAPI.Apply(prim.GetPrim())
        return prim.GetPrim()

    def _move(self, prim: Any, position: np.ndarray, quat: np.ndarray) -> None:
        double = self.pxr.UsdGeom.XformOp.PrecisionDouble
        prim.AddTranslateOp(double).Set(self.pxr.Gf.Vec3d(*map(float, position)))
        prim.AddOrientOp(double).Set(self.pxr.Gf.Quatd(*map(float, quat)))

    def _mass(self, prim: Any, mass: float, centre: np.ndarray, inertia: np.ndarray, quat: np.ndarray) -> None:
        """Set mass [kg], centre of mass [m] and principal moments [kg m2] of a body."""
        mass_api = self.pxr.UsdPhysics.MassAPI.Apply(prim)
        mass_api.CreateMassAttr(float(mass))
        mass_api.CreateCenterOfMassAttr(self.pxr.Gf.Vec3f(*map(float, centre)))
        mass_api.CreateDiagonalInertiaAttr(self.pxr.Gf.Vec3f(*map(float, inertia)))
        mass_api.CreatePrincipalAxesAttr(self.pxr.Gf.Quatf(*map(float, quat)))

    def _fixed(self, parent: _Link, child: _Link) -> None:
        """Define a joint that fixes a child to its parent."""
        gf, back = self.pxr.Gf, parent.turn.inv()
        joint = self.pxr.UsdPhysics.FixedJoint.Define(self.stage, f"{self.root}/joints/{child.name}_fixed")
        joint.CreateBody0Rel().SetTargets([f"{self.root}/{parent.name}"])
        joint.CreateBody1Rel().SetTargets([f"{self.root}/{child.name}"])
        joint.CreateLocalPos0Attr(gf.Vec3f(*back.apply(child.place - parent.place).tolist()))
        joint.CreateLocalRot0Attr(gf.Quatf(*(back * child.turn).as_quat(scalar_first=True).tolist()))

    def _joint(self, hinge: int, parent: _Link | None, child: _Link) -> _Link:
        """Define a revolute joint with its limits and its drive, and return the child."""
        assert parent is not None  # only the root has none, and no hinge
        name, gf = self.model.joint(hinge).name, self.pxr.Gf
        joint = self.pxr.UsdPhysics.RevoluteJoint.Define(self.stage, f"{self.root}/joints/{name}")
        axis, turn = _axis(self.model.jnt_axis[hinge])
        back = parent.turn.inv()
        joint.CreateBody0Rel().SetTargets([f"{self.root}/{parent.name}"])
        joint.CreateBody1Rel().SetTargets([f"{self.root}/{child.name}"])
        joint.CreateAxisAttr(axis)
        joint.CreateLocalPos0Attr(gf.Vec3f(*back.apply(child.place - parent.place).tolist()))
        joint.CreateLocalRot0Attr(gf.Quatf(*(back * child.turn * turn).as_quat(scalar_first=True).tolist()))
        joint.CreateLocalPos1Attr(gf.Vec3f(0.0, 0.0, 0.0))
        joint.CreateLocalRot1Attr(gf.Quatf(*turn.as_quat(scalar_first=True).tolist()))
        if self.model.jnt_limited[hinge]:
            lower_limit, upper_limit = np.degrees(self.model.jnt_range[hinge]).tolist()
            joint.CreateLowerLimitAttr(lower_limit)
            joint.CreateUpperLimitAttr(upper_limit)
        self._drive(joint.GetPrim(), name, hinge)
        return child

    def _drive(self, prim: Any, name: str, hinge: int) -> None:
        """Drive a joint by its servo, or by its spring; USD counts by the degree."""
        drive = self.pxr.UsdPhysics.DriveAPI.Apply(prim, "angular")
        drive.CreateTypeAttr("force")
        if name in layout(self.robot).servos:
            servo = self.robot.servo(name)
            stiffness, damping = servo.kp, servo.kd
            drive.CreateMaxForceAttr(servo.torque)
        else:
            dof = int(self.model.jnt_dofadr[hinge])
            stiffness = float(np.ravel(self.model.jnt_stiffness[hinge])[0])
            damping = float(np.ravel(self.model.dof_damping[dof])[0])
        drive.CreateStiffnessAttr(np.radians(stiffness).item())
        drive.CreateDampingAttr(np.radians(damping).item())
        drive.CreateTargetPositionAttr(np.degrees(self.targets.get(name, 0.0)).item())

    def _shape(self, geom: int, body: str) -> None:
        """Define the shape of a geom and the shape that collides, with the material of foot or skin."""
        kinds, geometry, model = mujoco.mjtGeom, self.pxr.UsdGeom, self.model
        kind, size, name = model.geom_type[geom], model.geom_size[geom].tolist(), model.geom(geom).name
        path = f"{self.root}/{body}/{name}_shape"
        if kind == kinds.mjGEOM_CAPSULE:
            shape = geometry.Capsule.Define(self.stage, path)
            shape.CreateAxisAttr("Z")
            shape.CreateRadiusAttr(size[0])
            shape.CreateHeightAttr(2 * size[1])
            extent = np.array([size[0], size[0], size[0] + size[1]])
        else:
            shape = geometry.Sphere.Define(self.stage, path)
            radius = size[0] if kind == kinds.mjGEOM_SPHERE else 1.0
            shape.CreateRadiusAttr(radius)
            extent = np.full(3, radius)
        shape.CreateExtentAttr([self.pxr.Gf.Vec3f(*(sign * extent).tolist()) for sign in (-1, 1)])
        self._move(shape, model.geom_pos[geom], model.geom_quat[geom])
        shape.CreateDisplayColorAttr([self.pxr.Gf.Vec3f(*model.geom_rgba[geom][:3].tolist())])
        if kind == kinds.mjGEOM_ELLIPSOID:
            shape.AddScaleOp().Set(self.pxr.Gf.Vec3f(*size))
            shape = self._hull(f"{self.root}/{body}/{name}_hull", geom)
        self.pxr.UsdPhysics.CollisionAPI.Apply(shape.GetPrim())
        material_name = "foot" if name.endswith("_foot") else "skin"
        material = self.pxr.UsdShade.Material.Get(self.stage, f"{self.root}/materials/{material_name}")
        binding = self.pxr.UsdShade.MaterialBindingAPI.Apply(shape.GetPrim())
        binding.Bind(material, self.pxr.UsdShade.Tokens.fallbackStrength, "physics")

    def _hull(self, path: str, geom: int) -> Any:
        """Write the faceted ball that an ellipsoid collides as, unseen."""
        size, gf = self.model.geom_size[geom], self.pxr.Gf
        lines = [line.split() for line in ball().splitlines()]
        corners = np.array([line[1:] for line in lines if line[0] == "v"], dtype=float) * size
        faces = np.array([line[1:] for line in lines if line[0] == "f"], dtype=int) - 1
        mesh = self.pxr.UsdGeom.Mesh.Define(self.stage, path)
        mesh.CreatePointsAttr(self.pxr.Vt.Vec3fArray.FromNumpy(corners.astype(np.float32)))
        mesh.CreateFaceVertexCountsAttr([3] * len(faces))
        mesh.CreateFaceVertexIndicesAttr(faces.ravel().tolist())
        mesh.CreateSubdivisionSchemeAttr("none")
        mesh.CreateExtentAttr([gf.Vec3f(*(sign * size).tolist()) for sign in (-1, 1)])
        mesh.CreatePurposeAttr("guide")
        self._move(mesh, self.model.geom_pos[geom], self.model.geom_quat[geom])
        self.pxr.UsdPhysics.MeshCollisionAPI.Apply(mesh.GetPrim()).CreateApproximationAttr("convexHull")
        return mesh


def _axis(vector: np.ndarray) -> tuple[str, Rotation]:
    """Return a joint's axis as USD names it, and how its frame is turned: not at all or half about, where it can be."""
    axis_index = int(np.argmax(np.abs(vector)))
    if np.count_nonzero(vector) == 1:
        turn = Rotation.identity() if vector[axis_index] > 0 else Rotation.from_quat(np.eye(4)[(axis_index + 1) % 3])
        return "XYZ"[axis_index], turn
    turn, _ = Rotation.align_vectors([vector], [np.eye(3)[0]])
    return "X", turn
