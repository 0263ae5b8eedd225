# cloth/scenes/sphere.yaml as Blender simulates it, for duite-bench contact: blender --background --python THIS -- SIDE FRAMES QUALITY OUT
# SIDE x SIDE vertices; QUALITY: steps a frame, a fifth as many passes of collisions. Writes the positions of all frames to OUT (doubles,
# y up), and prints the seconds that the frames took. The material is Blender's own default: its solver hardly moves vertices as light as the
# scene's.
import array
import sys
import time

import bpy

side, frames, quality = (int(word) for word in sys.argv[sys.argv.index("--") + 1 : sys.argv.index("--") + 4])
out = sys.argv[-1]
thickness = 0.002


def add_mesh(name, points, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(thing)
    return thing


def add_obstacle(thing):
    thing.modifiers.new("collision", "COLLISION")
    thing.collision.thickness_outer = thickness
    thing.collision.cloth_friction = 5
    return thing


def add_cloth():
    edge = 1 / (side - 1)
    points = [(i * edge - 0.5, j * edge - 0.5, 0.3 + 1e-4 * ((7 * i + 3 * j) % 5) / 5) for j in range(side) for i in range(side)]
    faces = [(a, a + 1, a + side + 1, a + side) for j in range(side - 1) for a in range(j * side, j * side + side - 1)]
    thing = add_mesh("sheet", points, faces)
    cloth = thing.modifiers.new("cloth", "CLOTH")
    settings, collisions = cloth.settings, cloth.collision_settings
    settings.quality = quality
    collisions.collision_quality = max(2, quality // 5)
    collisions.distance_min = thickness
    collisions.use_self_collision = True
    collisions.self_distance_min = thickness
    cloth.point_cache.frame_end = frames + 1
    return thing


bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps = 25
scene.frame_end = frames + 1
bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6, radius=0.25)
add_obstacle(bpy.context.object)
add_obstacle(add_mesh("floor", [(-2, -2, -0.25), (2, -2, -0.25), (2, 2, -0.25), (-2, 2, -0.25)], [(0, 1, 2, 3)]))
sheet = add_cloth()
scene.frame_set(1)
seconds = 0
with open(out, "wb") as file:
    for frame in range(2, frames + 2):
        begin = time.monotonic()
        scene.frame_set(frame)
        now = sheet.evaluated_get(bpy.context.evaluated_depsgraph_get())
        seconds += time.monotonic() - begin
        mesh = now.to_mesh()
        for vertex in mesh.vertices:
            x = now.matrix_world @ vertex.co
            array.array("d", (x.x, x.z, x.y)).tofile(file)
        now.to_mesh_clear()
print("seconds", seconds)
