"""blender -b --python read_blender.py -- FOLDER: with Blender's Mesh Cache each frame has the state's positions, as float32. A folder
of one cloth is imported as File > Import > Wavefront (.obj) does it, one of several by the legacy importer with Keep Vert Order."""
import os
import sys

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import read_back

folder = os.path.abspath(sys.argv[sys.argv.index('--') + 1])
states = read_back.states(folder)
mesh = os.path.join(folder, 'cloth.obj')
with open(mesh) as file:
    cloths = sum(line.startswith('o ') for line in file)

bpy.ops.wm.read_factory_settings(use_empty=True)
if cloths == 1:
    bpy.ops.wm.obj_import(filepath=mesh)
else:
    bpy.ops.import_scene.obj(filepath=mesh, split_mode='OFF')
(cloth,) = bpy.data.objects
cache = cloth.modifiers.new('Mesh Cache', 'MESH_CACHE')
cache.cache_format = 'PC2'
cache.filepath = os.path.join(folder, 'cloth.pc2')

if len(states) < 4:
    sys.exit('too few frames')
for k, (time, position, _) in enumerate(states):
    bpy.context.scene.frame_set(k)
    found = cloth.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.vertices
    numbers = numpy.empty(3 * len(found), numpy.float32)
    found.foreach_get('co', numbers)
    if not numpy.array_equal(numbers.reshape(-1, 3), numpy.array(position).astype(numpy.float32)):
        sys.exit(f'frame {k}: not the state')
    print(f'frame {k}, {cloths} cloths: {len(found)} vertices, positions are the state\'s as float32')
