"""The slider-crank of the transient in exudyn: three plane bodies, joints, friction on the slider.

Friction is the built-in one of `CoordinateSpringDamperExt`, regularised about zero velocity, so that no
Python runs inside the solver; time is integrated by the generalised-α method, as exudyn does with joints.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from peers.slider_crank import CRANK, DURATION, FRICTION, J_ROD, LAM, ROD, SLIDER, SPEED, TORQUE, L, R


def model(zone: float) -> Any:
    """The assembled machine; friction is proportional to the velocity below ``zone`` [m/s]."""
    # Loaded by name: the package's own type stubs lag behind it.
    exu: Any = import_module("exudyn")
    u: Any = import_module("exudyn.utilities")
    container = exu.SystemContainer()
    system = container.AddSystem()
    ground = system.AddObject(u.ObjectGround())
    crank, rod, slider = (_body(system, u, *row) for row in _bodies())
    at = [
        (ground, [0.0, 0.0, 0.0], crank[1], [0.0, 0.0, 0.0]),
        (crank[1], [R, 0.0, 0.0], rod[1], [-L / 2, 0.0, 0.0]),
        (rod[1], [L / 2, 0.0, 0.0], slider[1], [0.0, 0.0, 0.0]),
    ]
    for first, here, second, there in at:
        ends = [
            system.AddMarker(u.MarkerBodyPosition(bodyNumber=body, localPosition=place))
            for body, place in ((first, here), (second, there))
        ]
        system.AddObject(u.RevoluteJoint2D(markerNumbers=ends))
    fixed = system.AddNode(u.NodePointGround(referenceCoordinates=[0.0, 0.0, 0.0]))
    zero = system.AddMarker(u.MarkerNodeCoordinate(nodeNumber=fixed, coordinate=0))
    x, y, turn = (
        system.AddMarker(u.MarkerNodeCoordinate(nodeNumber=slider[0], coordinate=i)) for i in range(3)
    )
    system.AddObject(u.CoordinateConstraint(markerNumbers=[zero, y]))
    system.AddObject(u.CoordinateConstraint(markerNumbers=[zero, turn]))
    friction = {"dynamicFrictionForce": FRICTION, "frictionProportionalZone": zone}
    system.AddObject(u.CoordinateSpringDamperExt(markerNumbers=[zero, x], **friction))
    shaft = system.AddMarker(u.MarkerNodeCoordinate(nodeNumber=crank[0], coordinate=2))
    system.AddLoad(u.LoadCoordinate(markerNumber=shaft, load=TORQUE))
    options = {"storeInternal": True, "writeToFile": False}
    kind = exu.OutputVariableType.Coordinates_t
    sensor = system.AddSensor(u.SensorNode(nodeNumber=crank[0], outputVariableType=kind, **options))
    system.Assemble()
    return container, system, sensor


def _bodies() -> list[tuple[float, float, list[float], list[float]]]:
    """Mass, inertia, position and velocity at φ = 0 of crank, rod and slider."""
    # The crank turns about its centre of mass: its mass does nothing.
    crank = (1.0, CRANK, [0.0, 0.0, 0.0], [0.0, 0.0, SPEED])
    rod = (ROD, J_ROD, [R + L / 2, 0.0, 0.0], [0.0, 0.5 * R * SPEED, -LAM * SPEED])
    slider = (SLIDER, 1.0, [R + L, 0.0, 0.0], [0.0, 0.0, 0.0])
    return [crank, rod, slider]


def _body(system: Any, u: Any, mass: float, inertia: float, place: list[float], speed: list[float]) -> Any:
    """Node and object of a plane rigid body."""
    node = system.AddNode(u.NodeRigidBody2D(referenceCoordinates=place, initialVelocities=speed))
    body = u.ObjectRigidBody2D(physicsMass=mass, physicsInertia=inertia, nodeNumber=node)
    return node, system.AddObject(body)


def speeds(steps: int, zone: float, times: Any, radius: float = 0.9) -> Any:
    """Crank speed [rad/s] at given times, with a fixed number of steps."""
    exu: Any = import_module("exudyn")
    _container, system, sensor = model(zone)
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = DURATION
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.generalizedAlpha.spectralRadius = radius
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = DURATION / (len(times) - 1)
    settings.linearSolverType = exu.LinearSolverType.EXUdense
    system.SolveDynamic(settings)
    stored = system.GetSensorStoredData(sensor)
    return np.interp(times, stored[:, 0], stored[:, -1])
