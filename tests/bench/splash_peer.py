# Blender's liquid (Mantaflow) on the scene of splash_tool. For tests/bench/run.sh splash:
#   blender -b --factory-startup -P splash_peer.py -- SCENE CELLS OUT [KEY=VALUE ...]
# Reads scene.txt and path.txt of SCENE: numbers of the pool, and the middle of the ball four times a frame. The domain has
# CELLS cells along the pool; settings are Blender's own. Writes frames.txt into OUT: frames, seconds of CPU and of wall
# that the bake with its mesh took, bytes of memory; and then of each frame the volume of the mesh [m3] and its highest place [m].
# KEY=VALUE sets others of the domain, as mesh_particle_radius=1.5.
import math
import os
import resource
import shutil
import sys
import time

import bpy

scene_folder, cells, out, *options = sys.argv[sys.argv.index("--") + 1:]
numbers = {}
for line in open(os.path.join(scene_folder, "scene.txt")):
    key, value = line.split()
    numbers[key] = float(value)
path = [[float(word) for word in line.split()] for line in open(os.path.join(scene_folder, "path.txt"))]
frames, samples = int(numbers["frames"]), int(numbers["samples"])
size, depth, height, radius = numbers["size"], numbers["depth"], numbers["height"], numbers["radius"]


def box(name, low, high):
    bpy.ops.mesh.primitive_cube_add(size=1)
    thing = bpy.context.object
    thing.name = name
    thing.location = [0.5 * (a + b) for a, b in zip(low, high)]
    thing.scale = [b - a for a, b in zip(low, high)]
    bpy.ops.object.transform_apply()
    return thing


def fluid(thing, kind):
    bpy.context.view_layer.objects.active = thing
    bpy.ops.object.modifier_add(type="FLUID")
    thing.modifiers["Fluid"].fluid_type = kind
    return thing.modifiers["Fluid"]


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps = int(numbers["fps"])
scene.frame_start, scene.frame_end = 1, frames

half = 0.5 * size
domain_object = box("domain", (-half, -half, -depth), (half, half, height))
domain = fluid(domain_object, "DOMAIN").domain_settings
domain.domain_type = "LIQUID"
domain.resolution_max = int(cells)
domain.use_mesh = True
domain.cache_directory = os.path.join(out, "cache")
domain.cache_type = "ALL"
domain.cache_frame_start, domain.cache_frame_end = 1, frames
for key, value in (word.split("=") for word in options):
    setattr(domain, key, type(getattr(domain, key))(float(value)))

water = fluid(box("water", (-half, -half, -depth), (half, half, 0)), "FLOW").flow_settings
water.flow_type, water.flow_behavior = "LIQUID", "GEOMETRY"

bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=radius)
ball = bpy.context.object
for k, (x, y, z) in enumerate(path):
    ball.location = (x, -z, y)
    ball.keyframe_insert("location", frame=1 + k / samples)
for curve in ball.animation_data.action.fcurves:
    for point in curve.keyframe_points:
        point.interpolation = "LINEAR"
effector = fluid(ball, "EFFECTOR").effector_settings
effector.effector_type = "COLLISION"
effector.subframes = samples - 1

bpy.context.view_layer.objects.active = domain_object
wall, cpu = time.monotonic(), cpu_seconds()
bpy.ops.fluid.bake_all()
wall, cpu = time.monotonic() - wall, cpu_seconds() - cpu
if not domain.has_cache_baked_mesh:
    sys.exit("the liquid was not baked")


def measure(frame):
    scene.frame_set(frame)
    thing = domain_object.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = thing.to_mesh()
    mesh.calc_loop_triangles()
    places = [thing.matrix_world @ v.co for v in mesh.vertices]
    volume = 0.0
    for t in mesh.loop_triangles:
        a, b, c = (places[i] for i in t.vertices)
        volume += a.dot(b.cross(c)) / 6
    thing.to_mesh_clear()
    return volume, max((p.z for p in places), default=math.nan)


memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
with open(os.path.join(out, "frames.txt"), "w") as file:
    file.write("%d %.6f %.6f %d\n" % (frames, cpu, wall, memory))
    for frame in range(1, frames + 1):
        file.write("%.9f %.6f\n" % measure(frame))
shutil.rmtree(domain.cache_directory)
print("RESULT blender %s: %d frames, cells of %.4f m, %.3f s of CPU and %.3f s of wall each" %
      (bpy.app.version_string, frames, size / int(cells), cpu / frames, wall / frames))
