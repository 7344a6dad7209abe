# Run inside Blender by blender_test.cpp: opens a sequence of .vdb files as a volume, sets what `followthrough volumes` says that is
# to be set, and renders it from the side with and without motion blur.
#   blender -b --factory-startup --python blender_check.py -- FOLDER NAME FRAMES FPS VOXEL
# In the files are a cloud of droplets about y = 0.6 that moves along x, one about y = 1.1 that is still, and a surface that rises
# between x = 0 and x = 0.4. Prints "BLENDER name value" in metres; the test judges. Pictures stay in FOLDER.
import math
import os
import sys

import bpy

folder, name, frames, fps, voxel = sys.argv[sys.argv.index("--") + 1:]
k_width, k_height, k_pixel = 400, 320, 0.005  # px, px, m
k_middle = (0.2, 0.7)                        # of the picture, x and y as they are in the file [m]

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps = int(fps)
scene.frame_start, scene.frame_end = 1, int(frames)

# What a user does.
volume = bpy.data.volumes.new("water")
volume.filepath = os.path.join(folder, name + ".0001.vdb")
volume.is_sequence = True
volume.frame_duration = int(frames)
print("BLENDER default_unit", volume.velocity_unit)
volume.velocity_unit = "SECOND"
thing = bpy.data.objects.new("water", volume)
thing.rotation_euler = (math.pi / 2, 0, 0)  # files are Y-up
half = 0.5 * float(voxel)                    # by which Blender draws all voxels too far along the axes of the file
thing.location = (-half, half, -half)
scene.collection.objects.link(thing)

# Light that the spray gives off, and the inside of the surface.
material = bpy.data.materials.new("water")
material.use_nodes = True
tree = material.node_tree
tree.nodes.clear()
spray, surface = (tree.nodes.new("ShaderNodeAttribute") for _ in range(2))
spray.attribute_name, surface.attribute_name = "spray", "surface"
inside, both = (tree.nodes.new("ShaderNodeMath") for _ in range(2))
inside.operation, both.operation = "LESS_THAN", "ADD"
inside.inputs[1].default_value = 0
emission, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeOutputMaterial")
tree.links.new(surface.outputs["Fac"], inside.inputs[0])
tree.links.new(inside.outputs[0], both.inputs[0])
tree.links.new(spray.outputs["Fac"], both.inputs[1])
tree.links.new(both.outputs[0], emission.inputs["Strength"])
tree.links.new(emission.outputs[0], output.inputs["Volume"])
volume.materials.append(material)

scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = 32
scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
scene.cycles.max_bounces = 0
scene.render.motion_blur_shutter = 0.5
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = k_width, k_height, 100
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
camera = bpy.data.cameras.new("side")
camera.type = "ORTHO"
camera.ortho_scale = k_width * k_pixel
scene.camera = bpy.data.objects.new("side", camera)
scene.camera.location = (k_middle[0], -5, k_middle[1])
scene.camera.rotation_euler = (math.pi / 2, 0, 0)
scene.collection.objects.link(scene.camera)


def place_x(i):
    return k_middle[0] + (i + 0.5 - 0.5 * k_width) * k_pixel


def place_y(j):
    return k_middle[1] + (j + 0.5 - 0.5 * k_height) * k_pixel


def spread(places, weights):
    """Their mean and variance."""
    total = sum(weights)
    mean = sum(p * w for p, w in zip(places, weights)) / total
    return mean, sum((p - mean) ** 2 * w for p, w in zip(places, weights)) / total


def render(frame, blur):
    """Mean and variance of the moving and the still cloud along x, and of the surface's height."""
    scene.frame_set(frame)
    scene.render.use_motion_blur = blur
    scene.render.filepath = os.path.join(folder, "frame%d_%s.exr" % (frame, "blurred" if blur else "sharp"))
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = image.pixels[:]

    def along_x(low, high):
        rows = [j for j in range(k_height) if low < place_y(j) < high]
        return [sum(pixels[4 * (j * k_width + i)] for j in rows) for i in range(k_width)]

    xs = [place_x(i) for i in range(k_width)]
    columns = [i for i in range(k_width) if 0.1 < place_x(i) < 0.3]
    rows = [j for j in range(k_height) if -0.05 < place_y(j) < 0.4]
    up = [sum(pixels[4 * (j * k_width + i)] for i in columns) for j in rows]
    edge = [a - b for a, b in zip(up, up[1:])]
    heights = [place_y(j) - 0.5 * k_pixel for j in rows[1:]]
    return spread(xs, along_x(0.45, 0.8)), spread(xs, along_x(0.85, 1.4)), spread(heights, edge)


def streak(sharp, blurred):
    """How long a thing was drawn out evenly; negative where it became shorter."""
    grown = 12 * (blurred[1] - sharp[1])
    return math.copysign(math.sqrt(abs(grown)), grown)


frame = 3
sharp, later, blurred = render(frame, False), render(frame + 1, False), render(frame, True)
volume.grids.load()
print("BLENDER grids", "+".join(sorted(grid.name for grid in volume.grids)))
print("BLENDER velocity", volume.velocity_grid)
for k, what in enumerate(("moving", "still", "rising")):
    print("BLENDER %s_at %.6f" % (what, sharp[k][0]))
    print("BLENDER %s_moved %.6f" % (what, later[k][0] - sharp[k][0]))
    print("BLENDER %s_streak %.6f" % (what, streak(sharp[k], blurred[k])))

# The surface as a mesh, by Blender's modifier.
mesh_object = bpy.data.objects.new("mesh", bpy.data.meshes.new("mesh"))
scene.collection.objects.link(mesh_object)
modifier = mesh_object.modifiers.new("mesh", "VOLUME_TO_MESH")
modifier.object, modifier.grid_name, modifier.threshold = thing, "surface", 0
tops = []
for k in (frame, frame + 1):
    scene.frame_set(k)
    mesh = mesh_object.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    tops.append(max((mesh_object.matrix_world @ v.co).z for v in mesh.vertices))
print("BLENDER mesh_at %.6f" % tops[0])
print("BLENDER mesh_moved %.6f" % (tops[1] - tops[0]))

# Where half of the foam is.
modifier.grid_name, modifier.threshold = "foam", 0.5
scene.frame_set(frame)
mesh = mesh_object.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
places = [mesh_object.matrix_world @ v.co for v in mesh.vertices]
print("BLENDER foam_top %.6f" % max(p.z for p in places))
print("BLENDER foam_bottom %.6f" % min(p.z for p in places))
print("BLENDER foam_right %.6f" % max(p.x for p in places))
