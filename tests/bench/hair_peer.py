# Blender's hair dynamics on the scene of hair_tool. For tests/bench/run.sh hair:
#   blender -b --factory-startup -P hair_peer.py -- SCENE OUT [KEY=VALUE ...]
# Reads head.obj, groom.obj and yaw.txt of SCENE; writes peer.pc2, and timing.txt: seconds of CPU, and then the wall
# seconds of each frame, into OUT. Settings are Blender's own but for two distances, which are as large as the
# groom is away from the head: with its own (15 and 20 mm) this hair is not finite from the tenth frame on.
# KEY=VALUE sets others, as quality=10, of the cloth's settings.
import math
import os
import resource
import struct
import sys
import time

import bpy
import numpy

folder, out_folder, *options = sys.argv[sys.argv.index("--") + 1:]


def read_obj(name):
    """Its vertices, in Blender's axes, and its faces or lines."""
    points, elements = [], []
    for line in open(os.path.join(folder, name)):
        words = line.split()
        if words and words[0] == "v":
            points.append([float(w) for w in words[1:4]])
        if words and words[0] in "fl":
            elements.append([int(w.split("/")[0]) - 1 for w in words[1:]])
    return to_blender(numpy.array(points)), elements


def to_blender(points):
    return numpy.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)


def from_blender(points):
    return numpy.stack([points[:, 0], points[:, 2], -points[:, 1]], axis=1)


def activate(thing):
    for other in bpy.context.selected_objects:
        other.select_set(False)
    bpy.context.view_layer.objects.active = thing
    thing.select_set(True)


def head_object():
    points, faces = read_obj("head.obj")
    mesh = bpy.data.meshes.new("head")
    mesh.from_pydata(points.tolist(), [], faces)
    mesh.update()
    head = bpy.data.objects.new("head", mesh)
    bpy.context.scene.collection.objects.link(head)
    return head


def curves_of(head, strands, vertices):
    """A curves object with so many strands and vertices. It comes from particles: curves cannot be made by hand."""
    activate(head)
    bpy.ops.object.particle_system_add()
    emitter = head.particle_systems[0].settings
    emitter.type = "HAIR"
    emitter.count = strands
    bpy.context.view_layer.update()
    bpy.ops.curves.convert_from_particle_system()
    curves = next(o for o in bpy.data.objects if o.type == "CURVES")
    group = bpy.data.node_groups.new("resample", "GeometryNodeTree")
    group.inputs.new("NodeSocketGeometry", "Geometry")
    group.outputs.new("NodeSocketGeometry", "Geometry")
    resample = group.nodes.new("GeometryNodeResampleCurve")
    resample.inputs["Count"].default_value = vertices
    group.links.new(group.nodes.new("NodeGroupInput").outputs[0], resample.inputs[0])
    group.links.new(resample.outputs[0], group.nodes.new("NodeGroupOutput").inputs[0])
    curves.modifiers.new("resample", "NODES").node_group = group
    activate(curves)
    bpy.ops.object.modifier_apply(modifier="resample")
    activate(head)
    bpy.ops.object.particle_system_remove()
    return curves


def add_groom(head, groom, lines):
    curves = curves_of(head, len(lines), len(lines[0]))
    curves.data.points.foreach_set("position", groom.astype("f").ravel())
    curves.data.surface = head
    activate(curves)
    bpy.ops.curves.convert_to_particle_system()
    bpy.data.objects.remove(curves)
    activate(head)
    return head.particle_systems[0]


def strands_of(head):
    """Where the strands are, in the world."""
    now = head.evaluated_get(bpy.context.evaluated_depsgraph_get())
    modifier = next(m for m in now.modifiers if m.type == "PARTICLE_SYSTEM")
    places = [now.matrix_world @ key.co_object(now, modifier, particle)
              for particle in now.particle_systems[0].particles for key in particle.hair_keys]
    return numpy.array(places)


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
angles = [float(line) for line in open(os.path.join(folder, "yaw.txt"))]
groom, lines = read_obj("groom.obj")
scene.render.fps = 24
scene.frame_start, scene.frame_end = 1, len(angles)

head = head_object()
system = add_groom(head, groom, lines)
off = numpy.linalg.norm(strands_of(head) - groom, axis=1).max()
if off > 1e-3:
    sys.exit("the groom did not arrive: a vertex is %.1f mm off" % (1e3 * off))
head.modifiers.new("collision", "COLLISION")
head.collision.thickness_outer = 0.003
for frame, angle in enumerate(angles, 1):
    head.rotation_euler = (0, 0, angle)
    head.keyframe_insert("rotation_euler", frame=frame)
system.use_hair_dynamics = True
system.cloth.collision_settings.distance_min = 0.003
for key, value in (word.split("=") for word in options):
    setattr(system.cloth.settings, key, type(getattr(system.cloth.settings, key))(float(value)))
system.point_cache.frame_start, system.point_cache.frame_end = 1, len(angles)

scene.frame_set(1)
frames, wall, cpu = [from_blender(strands_of(head))], [], 0.0
for frame in range(2, len(angles) + 1):
    cpu_before, wall_before = cpu_seconds(), time.monotonic()
    scene.frame_set(frame)
    wall.append(time.monotonic() - wall_before)
    cpu += cpu_seconds() - cpu_before
    frames.append(from_blender(strands_of(head)))
    if not numpy.isfinite(frames[-1]).all() or numpy.abs(frames[-1]).max() > 1e3:
        print("not finite from frame %d on" % frame)
        frames.pop()
        break

with open(os.path.join(out_folder, "peer.pc2"), "wb") as out:
    out.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(groom), 1, 1, len(frames)))
    for points in frames:
        out.write(points.astype("<f4").tobytes())
with open(os.path.join(out_folder, "timing.txt"), "w") as out:
    out.write("%.6f\n%s\n" % (cpu, " ".join("%.6f" % w for w in wall)))
print("RESULT blender %s: %d frames, %.3f s of CPU and %.3f s each, the groom %.3f mm off" %
      (bpy.app.version_string, len(frames), cpu / len(wall), sum(wall) / len(wall), 1e3 * off))
