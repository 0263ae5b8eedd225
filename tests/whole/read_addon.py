"""In Blender: the add-on exports a turned sheet that two corners hold above a moving ball, runs it, and brings it back."""
import os, struct, sys
import bpy

addon, program, folder = sys.argv[sys.argv.index('--') + 1:]
sys.path.insert(0, os.path.dirname(addon))
import duite_cloth

bpy.ops.wm.read_factory_settings(use_empty=True)
duite_cloth.register()
scene = bpy.context.scene
scene.frame_end, scene.render.fps = 6, 25
bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8, radius=0.2, location=(0, 0, -0.25))
ball = bpy.context.object
ball.modifiers.new('Collision', 'COLLISION')
ball.keyframe_insert('location', frame=1)
ball.location.x = 0.1
ball.keyframe_insert('location', frame=6)
bpy.ops.mesh.primitive_grid_add(x_subdivisions=12, y_subdivisions=12, size=1, rotation=(0, 0, 0.7), location=(0.1, 0.2, 0.05))
cloth = bpy.context.object
bpy.context.view_layer.update()
group = cloth.vertex_groups.new(name='held')
group.add([0, 12], 1, 'REPLACE')
group.add([5], 0.2, 'REPLACE')
cloth.duite.pins, cloth.duite.program, cloth.duite.thickness = 'held', program, 0.005


def fails(sentence, call):
    try:
        call()
    except RuntimeError as error:
        if sentence in str(error):
            return
        sys.exit('not %s but %s' % (sentence, error))
    sys.exit('no error: ' + sentence)


fails('Save the .blend file first', bpy.ops.duite.simulate)
bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, 'sheet.blend'))
cloth.duite.program = 'no-such-program'
fails('no-such-program is not found', bpy.ops.duite.simulate)
cloth.duite.program, cloth.duite.pins = program, 'nothing'
fails('has no vertex group nothing', bpy.ops.duite.simulate)
cloth.duite.pins = 'held'
if bpy.ops.duite.simulate() != {'FINISHED'}:
    sys.exit('the run failed')

data = open(os.path.join(folder, 'duite-' + bpy.path.clean_name(cloth.name), 'frames', 'cloth.pc2'), 'rb').read()
n, frames = struct.unpack('<12siiffi', data[:32])[2::3]
if (n, frames) != (len(cloth.data.vertices), 6):
    sys.exit('the cache has %d vertices and %d frames' % (n, frames))
lowest = 0
for frame in range(6):
    scene.frame_set(frame + 1)
    graph = bpy.context.evaluated_depsgraph_get()
    seen = cloth.evaluated_get(graph)
    points = struct.unpack_from('<%df' % (3 * n), data, 32 + 12 * n * frame)
    for v, vertex in enumerate(seen.to_mesh().vertices):
        at = seen.matrix_world @ vertex.co
        if any(abs(at[c] - points[3 * v + c]) > 1e-6 for c in range(3)):
            sys.exit('frame %d, vertex %d is at %s, not at %s' % (frame, v, tuple(at), points[3 * v:3 * v + 3]))
        lowest = min(lowest, at.z)
        start = cloth.matrix_world @ cloth.data.vertices[v].co
        if v in (0, 12) and (at - start).length > 1e-6:
            sys.exit('vertex %d is not held' % v)
    seen.to_mesh_clear()
if not -0.3 < lowest < -0.02:
    sys.exit('the sheet has fallen to %g' % lowest)
cloth.duite.pin_stiffness = 20
if bpy.ops.duite.export() != {'FINISHED'}:
    sys.exit('the scene of soft pins is not written')
weights = [float(line) for line in open(os.path.join(folder, 'duite-' + bpy.path.clean_name(cloth.name), 'pins.txt'))]
if len(weights) != n or {v: round(w, 6) for v, w in enumerate(weights) if w} != {0: 1, 5: 0.2, 12: 1}:
    sys.exit('the weights are %s' % weights)
duite_cloth.unregister()
print('brought back')
