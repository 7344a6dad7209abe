# Run inside Blender by blender_test.cpp: imports an Alembic file with Blender's own Alembic library and a PC2 file with its Mesh Cache
# modifier, and compares every vertex of every frame, the faces and the uvs with what the test wrote down.
#   blender -b --factory-startup --python blender_check.py -- EXPECTED.json CACHE.abc CACHE.pc2
# Prints one line "BLENDER name value" per measurement; the test judges. Y-up metres become Blender's Z-up: (x, y, z) -> (x, -z, y).
import json
import sys

import bpy


def z_up(p):
    return (p[0], -p[2], p[1])


def positions_now(thing):
    bpy.context.view_layer.update()
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    out = [tuple(thing.matrix_world @ v.co) for v in mesh.vertices]
    evaluated.to_mesh_clear()
    return out


def largest_difference(a, b):
    if len(a) != len(b):
        return 1e30
    return max((abs(x - y) for p, q in zip(a, b) for x, y in zip(p, q)), default=0.0)


def canonical(corners):
    first = corners.index(min(corners))
    return corners[first:] + corners[:first]


def faces_of(mesh):
    return [list(p.vertices) for p in mesh.polygons]


expected_path, abc_path, pc2_path = sys.argv[sys.argv.index("--") + 1:]
with open(expected_path) as file:
    expected = json.load(file)
scene = bpy.context.scene
scene.render.fps = int(expected["fps"])
first = expected["first_frame"]


def check_alembic():
    bpy.ops.wm.alembic_import(filepath=abc_path, as_background_job=False, set_frame_range=True)
    meshes = [o for o in bpy.data.objects if o.type == "MESH"]
    print("BLENDER meshes", len(meshes))
    cloth = meshes[0]
    print("BLENDER name", cloth.name)
    print("BLENDER range", scene.frame_start, scene.frame_end)
    print("BLENDER faces", int([canonical(f) for f in faces_of(cloth.data)] == [canonical(f) for f in expected["faces"]]))
    uvs = {}
    if cloth.data.uv_layers:
        layer = cloth.data.uv_layers[0].data
        for p in cloth.data.polygons:
            for loop in p.loop_indices:
                uvs[(p.index, cloth.data.loops[loop].vertex_index)] = tuple(layer[loop].uv)
    wanted = {(f, v): tuple(uv) for f, (vs, us) in enumerate(zip(expected["faces"], expected["uvs"])) for v, uv in zip(vs, us)}
    same_keys = uvs.keys() == wanted.keys()
    print("BLENDER uvs", max(abs(a - b) for k in wanted for a, b in zip(uvs[k], wanted[k])) if same_keys else 1e30)
    worst = 0.0
    for i, frame in enumerate(expected["positions"]):
        scene.frame_set(first + i)
        worst = max(worst, largest_difference(positions_now(cloth), [z_up(p) for p in frame]))
    print("BLENDER abc", worst)


bpy.ops.object.select_all(action="SELECT")
bpy.ops.object.delete()
has_alembic = bpy.app.build_options.alembic
print("BLENDER has_alembic", int(has_alembic))
if has_alembic:
    check_alembic()

mesh = bpy.data.meshes.new("rest")
mesh.from_pydata([(0, 0, 0)] * len(expected["positions"][0]), [], expected["faces"])
thing = bpy.data.objects.new("pc2", mesh)
scene.collection.objects.link(thing)
modifier = thing.modifiers.new("cache", "MESH_CACHE")
modifier.cache_format = "PC2"
modifier.filepath = pc2_path
modifier.frame_start = first
modifier.forward_axis, modifier.up_axis = "POS_Z", "NEG_Y"
worst = 0.0
for i, frame in enumerate(expected["positions"]):
    scene.frame_set(first + i)
    worst = max(worst, largest_difference(positions_now(thing), [z_up(p) for p in frame]))
print("BLENDER pc2", worst)
