"""duite in Blender: the active mesh becomes a cloth, duite-cloth simulates it, and its vertices come back as a Mesh Cache.

Files hold Blender's own coordinates of the world, metres with z upwards, so the scene's gravity is along -z. A cache that comes
back is turned into the object's own axes, since the modifier knows no others. All that a run needs and leaves is in one folder,
`duite-NAME` beside the .blend file; its scene.yaml can be changed by hand, and run without Blender.
"""

import array
import os
import shutil
import struct
import subprocess

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

bl_info = {
    "name": "duite cloth",
    "author": "The duite authors",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "View3D > Sidebar > duite",
    "description": "Simulates cloth that goes through nothing, by duite-cloth",
    "category": "Physics",
}

PC2_HEADER = "<12siiffi"  # signature, version, points, first frame, step, frames
HELD = 0.5  # the weight in a group from which on a vertex is held
SETTLES = 0.1  # s: damping over stiffness of soft pins

# Usual weights (kg/m2), moduli of stretch and shear (N/m), and rigidities (N m).
FABRICS = {
    "cotton": (0.12, 1500, 100, 6e-6),
    "denim": (0.4, 4000, 400, 6e-5),
    "jersey": (0.18, 300, 100, 3e-6),
    "silk": (0.06, 1500, 50, 2e-6),
}


class Settings(bpy.types.PropertyGroup):
    """What the panel asks for, kept with each object."""

    fabric: EnumProperty(
        name="Fabric",
        items=[(name, name.capitalize(), "") for name in FABRICS],
        default="cotton",
        description="Weight and stiffness; scene.yaml has the numbers",
    )
    pins: StringProperty(name="Pins", description="Vertex group whose vertices are held: those of a weight above 1/2")
    pin_stiffness: FloatProperty(
        name="Pin Stiffness", default=0, min=0, soft_max=100, description="N/m of a vertex, times its weight: pins that give; 0: they hold"
    )
    thickness: FloatProperty(
        name="Thickness", default=0.002, min=1e-5, soft_max=0.02, unit="LENGTH", description="Surfaces keep this distance; well below the edges"
    )
    friction: FloatProperty(name="Friction", default=0.3, min=0, soft_max=1)
    steps: IntProperty(name="Steps a Frame", default=4, min=1, max=100, description="More of them resolve fast motion better")
    self_contact: BoolProperty(name="Self-Contact", default=True, description="The cloth does not go through itself")
    program: StringProperty(name="Program", default="duite-cloth", subtype="FILE_PATH")
    threads: IntProperty(name="Threads", default=0, min=0, description="0: all cores")


# ---- Out ----


def run_folder(cloth):
    """The folder of a cloth's run."""
    if not bpy.data.filepath:
        raise RuntimeError("Save the .blend file first: the run's folder is made beside it")
    return os.path.join(os.path.dirname(bpy.data.filepath), "duite-" + bpy.path.clean_name(cloth.name))


def flat_places(mesh, world):
    """The vertices of a mesh in the world, one number after the other."""
    flat = array.array("d")
    for vertex in mesh.vertices:
        flat.extend(world @ vertex.co)
    return flat


def write_obj(path, points, faces):
    """Writes polygons as they are, so that vertex i of the file is vertex i of the mesh."""
    with open(path, "w", encoding="utf-8") as file:
        for i in range(0, len(points), 3):
            file.write("v %.9g %.9g %.9g\n" % tuple(points[i : i + 3]))
        for face in faces:
            file.write("f %s\n" % " ".join(str(corner + 1) for corner in face))


def write_cache(path, frames):
    """Writes a PC2 point cache."""
    with open(path, "wb") as file:
        file.write(struct.pack(PC2_HEADER, b"POINTCACHE2\0", 1, len(frames[0]) // 3, 0, 1, len(frames)))
        for points in frames:
            array.array("f", points).tofile(file)


def find_colliders(scene, cloth):
    """The meshes with a Collision modifier."""
    return [o for o in scene.objects if o != cloth and o.type == "MESH" and any(m.type == "COLLISION" for m in o.modifiers)]


def film_colliders(context, colliders):
    """For each collider its faces, and its vertices in each frame of the scene, modifiers applied."""
    scene, now = context.scene, context.scene.frame_current
    filmed = [([], []) for _ in colliders]
    for frame in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(frame)
        graph = context.evaluated_depsgraph_get()
        for collider, (faces, frames) in zip(colliders, filmed):
            seen = collider.evaluated_get(graph)
            mesh = seen.to_mesh()
            faces[:] = [list(polygon.vertices) for polygon in mesh.polygons]
            frames.append(flat_places(mesh, seen.matrix_world))
            seen.to_mesh_clear()
            if len(frames[-1]) != len(frames[0]):
                raise RuntimeError("%s: frame %d has other vertices than the frames before" % (collider.name, frame))
    scene.frame_set(now)
    return filmed


def quoted(text):
    """A text as YAML takes any."""
    return "'" + text.replace("'", "''") + "'"


def write_colliders(folder, context, cloth):
    """Writes the colliders' files; the lines of the scene that name them."""
    colliders, lines = find_colliders(context.scene, cloth), []
    for i, (collider, (faces, frames)) in enumerate(zip(colliders, film_colliders(context, colliders))):
        write_obj(os.path.join(folder, "body-%d.obj" % i), frames[0], faces)
        moves = any(points != frames[0] for points in frames)
        if moves:
            write_cache(os.path.join(folder, "body-%d.pc2" % i), frames)
        motion = ", frames: {pc2: body-%d.pc2, fps: %.9g}" % (i, rate(context.scene)) if moves else ""
        lines.append("  - body: {obj: body-%d.obj, name: %s%s}" % (i, quoted(collider.name), motion))
    return lines


def rate(scene):
    """Frames a second."""
    return scene.render.fps / scene.render.fps_base


def find_weights(cloth):
    """The weight of each vertex in the group that pins it; none without one."""
    name = cloth.duite.pins
    if not name:
        return []
    if name not in cloth.vertex_groups:
        raise RuntimeError("%s has no vertex group %s to be pinned by" % (cloth.name, name))
    number = cloth.vertex_groups[name].index
    return [next((g.weight for g in v.groups if g.group == number), 0) for v in cloth.data.vertices]


def write_pins(folder, cloth):
    """The line of the scene that pins the cloth, and the file of weights that it names; none where nothing is pinned."""
    weights, stiffness = find_weights(cloth), cloth.duite.pin_stiffness
    held = [i for i, weight in enumerate(weights) if weight > HELD]
    if not stiffness:
        return ["    pins: [{vertices: %s}]" % held] if held else []
    if not any(weights):
        return []
    with open(os.path.join(folder, "pins.txt"), "w", encoding="utf-8") as file:
        file.writelines("%.9g\n" % weight for weight in weights)
    return ["    pins: [{weights: {file: pins.txt}, stiffness: %.9g, damping: %.9g}]" % (stiffness, SETTLES * stiffness)]


def scene_text(context, cloth, pins, obstacles):
    """The scene file."""
    scene, settings = context.scene, cloth.duite
    density, stretch, shear, rigidity = FABRICS[settings.fabric]
    gravity = tuple(scene.gravity) if scene.use_gravity else (0, 0, 0)
    fps = rate(scene)
    lines = [
        "# %s of %s, by the Blender add-on: metres, z upwards." % (cloth.name, os.path.basename(bpy.data.filepath)),
        "schema: 1",
        "gravity: [%.9g, %.9g, %.9g]" % gravity,
        "cloths:",
        "  - name: %s" % quoted(cloth.name),
        "    mesh: {file: cloth.obj}",
        "    material: fabric",
        *pins,
        "materials:",
        "  fabric: {density: %g, model: triangles, stretch: %g, shear: %g, poisson: 0.3," % (density, stretch, shear),
        "           bending: {rigidity: %g}, friction: %.9g, damping: {stiffness: 0.005, mass: 0.5}}" % (rigidity, settings.friction),
    ]
    lines += ["obstacles:"] + obstacles if obstacles else []
    if obstacles or settings.self_contact:
        contact = "on" if settings.self_contact else "off"
        lines.append("contact: {mode: certified, self: %s, thickness: %.9g}" % (contact, settings.thickness))
    end = (scene.frame_end - scene.frame_start) / fps
    lines.append("time: {h: %.9g, end: %.9g, fps: %.9g}" % (1 / (fps * settings.steps), end, fps))
    return "\n".join(lines) + "\n"


def write_scene(context, cloth):
    """Writes all files of a run anew; its folder."""
    folder = run_folder(cloth)
    os.makedirs(folder, exist_ok=True)
    write_obj(
        os.path.join(folder, "cloth.obj"),
        flat_places(cloth.data, cloth.matrix_world),
        [list(polygon.vertices) for polygon in cloth.data.polygons],
    )
    text = scene_text(context, cloth, write_pins(folder, cloth), write_colliders(folder, context, cloth))
    with open(os.path.join(folder, "scene.yaml"), "w", encoding="utf-8") as file:
        file.write(text)
    return folder


# ---- The run ----


def start_run(folder, settings):
    """Starts duite-cloth; what it says is in run.log."""
    program = bpy.path.abspath(settings.program) if os.sep in settings.program else shutil.which(settings.program)
    if not program or not os.access(program, os.X_OK):
        raise RuntimeError("%s is not found: name it in the panel" % settings.program)
    frames = os.path.join(folder, "frames")
    shutil.rmtree(frames, ignore_errors=True)
    command = [program, "scene.yaml", "--output", "frames", "--quiet"]
    if settings.threads:
        command.append("--threads=%d" % settings.threads)
    with open(os.path.join(folder, "run.log"), "wb") as log:
        return subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)


def frames_done(folder):
    """How many frames are on the disk."""
    try:
        with open(os.path.join(folder, "frames", "cloth.pc2"), "rb") as file:
            return struct.unpack(PC2_HEADER, file.read(struct.calcsize(PC2_HEADER)))[5]
    except (OSError, struct.error):
        return 0


def run_error(folder):
    """The last line that the run said."""
    with open(os.path.join(folder, "run.log"), encoding="utf-8", errors="replace") as file:
        lines = file.read().strip().splitlines()
    return lines[-1] if lines else "it said nothing: see run.log"


# ---- Back ----


def turn_cache(folder, cloth):
    """Writes the run's cache in the object's own axes; its path."""
    path, inverse = os.path.join(folder, "cloth.pc2"), cloth.matrix_world.inverted()
    rows = [tuple(inverse[i]) for i in range(3)]
    size = struct.calcsize(PC2_HEADER)
    with open(os.path.join(folder, "frames", "cloth.pc2"), "rb") as file:
        head, points = file.read(size), array.array("f", file.read())
    if struct.unpack(PC2_HEADER, head)[2] != len(cloth.data.vertices):
        raise RuntimeError("%s has other vertices than when it was simulated: simulate it again" % cloth.name)
    turned = array.array("f", bytes(4 * len(points)))
    for i in range(0, len(points), 3):
        x, y, z = points[i : i + 3]
        for c, (a, b, d, e) in enumerate(rows):
            turned[i + c] = a * x + b * y + d * z + e
    with open(path, "wb") as file:
        file.write(head)
        turned.tofile(file)
    return path


def bring_back(context, cloth):
    """Gives the object the cache of its run."""
    path = turn_cache(run_folder(cloth), cloth)
    cache = cloth.modifiers.get("duite") or cloth.modifiers.new("duite", "MESH_CACHE")
    cache.cache_format = "PC2"
    cache.filepath = path
    cache.frame_start = context.scene.frame_start
    while cloth.modifiers[0] != cache:
        bpy.ops.object.modifier_move_up({"object": cloth, "active_object": cloth}, modifier=cache.name)


class DUITE_OT_simulate(bpy.types.Operator):
    """Simulate the active mesh over the frames of the scene; Esc stops, and keeps the frames so far"""

    bl_idname = "duite.simulate"
    bl_label = "Simulate"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        """A mesh in object mode."""
        return context.object is not None and context.object.type == "MESH" and context.mode == "OBJECT"

    def execute(self, context):
        """Runs to the end: from scripts."""
        try:
            self.begin(context)
            self.process.wait()
            return self.end(context)
        except (RuntimeError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}

    def begin(self, context):
        """Writes the scene and starts the run."""
        self.cloth = context.object
        cache = self.cloth.modifiers.get("duite")
        if cache:
            self.cloth.modifiers.remove(cache)
        self.folder = write_scene(context, self.cloth)
        self.process = start_run(self.folder, self.cloth.duite)

    def end(self, context):
        """Brings back what there is of a run that ended."""
        stopped = self.process.returncode
        if frames_done(self.folder):
            bring_back(context, self.cloth)
        if not stopped:
            return {"FINISHED"}
        self.report({"ERROR"}, "duite-cloth: " + run_error(self.folder))
        return {"FINISHED"} if frames_done(self.folder) else {"CANCELLED"}

    def invoke(self, context, event):
        """Runs beside Blender, from the panel."""
        try:
            self.begin(context)
        except (RuntimeError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.timer = context.window_manager.event_timer_add(0.5, window=context.window)
        context.window_manager.progress_begin(0, context.scene.frame_end - context.scene.frame_start + 1)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """Looks how far the run is."""
        if event.type == "ESC":
            self.process.terminate()
        if event.type not in {"TIMER", "ESC"}:
            return {"PASS_THROUGH"}
        context.window_manager.progress_update(frames_done(self.folder))
        if self.process.poll() is None:
            return {"RUNNING_MODAL"}
        context.window_manager.event_timer_remove(self.timer)
        context.window_manager.progress_end()
        try:
            return self.end(context)
        except (RuntimeError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}


class DUITE_OT_export(bpy.types.Operator):
    """Write the scene of the active mesh without running it"""

    bl_idname = "duite.export"
    bl_label = "Write Scene"

    poll = DUITE_OT_simulate.poll

    def execute(self, context):
        """Says where the scene is."""
        try:
            self.report({"INFO"}, os.path.join(write_scene(context, context.object), "scene.yaml"))
        except (RuntimeError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class DUITE_PT_panel(bpy.types.Panel):
    """Settings of the active mesh"""

    bl_idname = "DUITE_PT_panel"
    bl_label = "duite"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "duite"

    @classmethod
    def poll(cls, context):
        """A mesh."""
        return context.object is not None and context.object.type == "MESH"

    def draw(self, context):
        """One column."""
        column, settings = self.layout.column(), context.object.duite
        column.prop(settings, "fabric")
        column.prop_search(settings, "pins", context.object, "vertex_groups")
        for name in ("pin_stiffness", "thickness", "friction", "steps", "self_contact", "program", "threads"):
            column.prop(settings, name)
        column.operator("duite.simulate")
        column.operator("duite.export")
        column.label(text="Meshes with a Collision modifier are met.")


CLASSES = (Settings, DUITE_OT_simulate, DUITE_OT_export, DUITE_PT_panel)


def register():
    """When the add-on is switched on."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.duite = PointerProperty(type=Settings)


def unregister():
    """When it is switched off."""
    del bpy.types.Object.duite
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
