"""A cloud drawn by Blender's Cycles, for scripts/compare-cycles.

blender --background --python cycles_cloud.py -- CLOUD.vdb SAMPLES SEED OUTPUT.exr
"""
import math
import sys

import bpy
from mathutils import Vector

cloud, samples, seed, output = sys.argv[sys.argv.index("--") + 1:]

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.engine = "CYCLES"
bpy.ops.object.volume_import(filepath=cloud)
volume = bpy.context.object

# Extinction 0.05 for each unit of density and length, all of it scattering.
material = bpy.data.materials.new("cloud")
material.use_nodes = True
tree = material.node_tree
tree.nodes.clear()
result = tree.nodes.new("ShaderNodeOutputMaterial")
matter = tree.nodes.new("ShaderNodeVolumePrincipled")
matter.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
matter.inputs["Density"].default_value = 0.05
matter.inputs["Density Attribute"].default_value = "density"
matter.inputs["Anisotropy"].default_value = 0.5
tree.links.new(matter.outputs["Volume"], result.inputs["Volume"])
material.cycles.volume_interpolation = "LINEAR"
volume.data.materials.clear()
volume.data.materials.append(material)


def turn(thing, direction, axis):
    thing.rotation_mode = "QUATERNION"
    thing.rotation_quaternion = direction.to_track_quat(axis, "Y")


sun = bpy.data.lights.new("sun", "SUN")
sun.energy = math.pi  # irradiance
sun.angle = 0.0
sun.cycles.max_bounces = 1024
sun_object = bpy.data.objects.new("sun", sun)
scene.collection.objects.link(sun_object)
turn(sun_object, Vector((0.5, -0.6, 0.6)), "Z")

camera = bpy.data.cameras.new("camera")
camera.sensor_fit = "VERTICAL"
camera.angle = math.radians(15.0)
camera.clip_start = 1.0
camera.clip_end = 1e6
camera_object = bpy.data.objects.new("camera", camera)
scene.collection.objects.link(camera_object)
camera_object.location = Vector((0.0, -4500.0, 900.0))
turn(camera_object, Vector((-60.0, 0.0, 480.0)) - camera_object.location, "-Z")
scene.camera = camera_object

world = bpy.data.worlds.new("world")
world.use_nodes = True
world.node_tree.nodes["Background"].inputs[0].default_value = (0.0, 0.0, 0.0, 1.0)
scene.world = world

render = scene.render
render.resolution_x = 256
render.resolution_y = 256
render.resolution_percentage = 100
render.filepath = output
render.image_settings.file_format = "OPEN_EXR"
render.image_settings.color_depth = "32"

# Paths through the pixels' middles, as many scatterings as Cycles can count, nothing left out.
cycles = scene.cycles
cycles.device = "CPU"
cycles.samples = int(samples)
cycles.seed = int(seed)
cycles.use_adaptive_sampling = False
cycles.use_denoising = False
cycles.max_bounces = 1024
cycles.volume_bounces = 1024
cycles.sample_clamp_direct = 0.0
cycles.sample_clamp_indirect = 0.0
cycles.light_sampling_threshold = 0.0
cycles.pixel_filter_type = "BOX"
cycles.filter_width = 0.01

bpy.ops.render.render(write_still=True)
