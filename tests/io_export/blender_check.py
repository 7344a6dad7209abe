# Run inside Blender by blender_test.cpp: opens a GLB or a BVH with Blender's own importers and compares where the heads of the bones are
# with what the test wrote down.
#   blender -b --factory-startup --python blender_check.py -- EXPECTED.json FILE
# Prints "BLENDER name value"; the test judges. Y-up metres become Blender's Z-up: (x, y, z) -> (x, -z, y). Debian's Blender 3.4.1 needs two
# repairs with its own Python 3.11: numpy.bool and the mode "U" of open() are gone.
import builtins
import json
import sys

import bpy
import numpy

if not hasattr(numpy, "bool"):
    numpy.bool = bool
plain_open = builtins.open
builtins.open = lambda file, mode="r", *rest, **named: plain_open(file, mode.replace("U", ""), *rest, **named)

expected_path, path = sys.argv[sys.argv.index("--") + 1:]
with open(expected_path) as file:
    expected = json.load(file)
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps = int(expected["fps"])
if path.endswith(".bvh"):
    bpy.ops.import_anim.bvh(filepath=path, axis_forward="-Z", axis_up="Y", use_fps_scale=False, update_scene_fps=False, frame_start=1)
    expected["frames"] = [frame + 1 for frame in expected["frames"]]  # it does not begin before frame 1
else:
    bpy.ops.import_scene.gltf(filepath=path)
armature = next(o for o in bpy.data.objects if o.type == "ARMATURE")
if armature.animation_data and armature.animation_data.nla_tracks:
    for track in armature.animation_data.nla_tracks:
        track.mute = True
    armature.animation_data.action = next(a for a in bpy.data.actions if a.name.startswith(expected["clip"]))
worst, compared = 0.0, 0
for frame, joints in zip(expected["frames"], expected["joints"]):
    scene.frame_set(int(frame), subframe=frame - int(frame))
    bpy.context.view_layer.update()
    for name, (x, y, z) in joints.items():
        bone = armature.pose.bones.get(name)
        if bone is None:
            continue
        head = armature.matrix_world @ bone.head
        compared += 1
        worst = max(worst, abs(head[0] - x), abs(head[1] + z), abs(head[2] - y))
print("BLENDER bones", compared // len(expected["frames"]))
print("BLENDER worst", worst)
