/* Keys of the obstacles that cloth meets. */
#include "cloth/scene/schema/tables.h"

/* clang-format off */
static const struct scene_section every_obstacle = {"Every obstacle", NULL, NULL};
#define MOVES \
    {"name", SCENE_TEXT, .shared = &every_obstacle, \
     .about = "for contact.pairs, contact.ignore, pins that follow and probes; no other " \
     "obstacle and no material has it"}, \
    {"groups", SCENE_LIST, .filled = true, .inside = &scene_text, .shared = &every_obstacle, \
     .about = "names for contact.ignore, of your choice"}, \
    {"friction", SCENE_NUMBER, .range = SCENE_COEFFICIENT, .shared = &every_obstacle, \
     .about = "coefficient of contact; else that of contact", .needs = NEEDS_MET}, \
    {"motion", SCENE_MAP, .inside = scene_motion_keys, .shared = &every_obstacle, \
     .about = "from where the other keys say, by key frames; it need not begin there", \
     .more = "In a step the surface has the velocity of its chord, from its place at the begin " \
     "of the step to that at the end.", .needs = NEEDS_MOVING, .section = &scene_motion}

const struct scene_section scene_obstacles_section = {"Obstacles",
    "Each entry has one of the kinds below as its key. By `contact.mode: project` a vertex in an "
    "obstacle leaves it by the nearest way, without friction. Only vertices are tested, so an "
    "obstacle should be larger than the cells of the cloth, and should move by less than half "
    "its thickness in a step. Cloth that starts inside an obstacle draws a warning by `project`, "
    "and is an error by `certified` (or see [`contact.untangle`](#starts-that-are-tangled)). "
    "Points and lengths are less than 10^6 m.\n\n"
    "`duite-cloth --check-intersections` finds in each frame what went through an obstacle, or "
    "through other cloth. `cloth/scenes/push.yaml` is an example:\n\n"
    "![A ball pushes a hanging sheet out of its way; a box stands in front of the "
    "sheet](push.png)\n\n"
    "```sh\n"
    "duite-cloth push.yaml --output pushed\n"
    "duite-view pushed --frame 32 --camera=-110,12 --size 960x540 --png push.png\n"
    "```",
    "obstacles:\n"
    "  - plane: {point: [0, 0, 0], normal: [0, 1, 0], name: floor, friction: 0.5}\n"
    "  - sphere: {centre: [0, 0.6, -0.3], radius: 0.12, motion: {times: [0, 1], translate: [[0, "
    "0, 0], [0, 0, 0.5]]}}\n"
    "  - box: {centre: [0, 0.15, 0.3], size: [0.2, 0.3, 0.2]}\n"
    "  - capsule: {from: [0, 0, 0], to: [0, 1, 0], radius: 0.02}\n"
    "  - cylinder: {centre: [0, 0.5, 0], axis: [0, 1, 0], radius: 0.09, length: 0.01, groups: "
    "[props]}\n"
    "  - body: {obj: figure.obj, scale: 0.01, motion: {times: [0, 2], rotate: [[1, 0, 0, 0], [1, "
    "0, 1, 0]]}}\n"};
static const struct scene_rule plane_keys[] = {
    {"point", SCENE_LIST, "m", .required = true, .length = 3, .inside = &scene_number,
     .about = "any point of it"},
    {"normal", SCENE_LIST, .required = true, .length = 3, .inside = &scene_number,
     .about = "towards the free side, of any length but 0"},
    MOVES,
    {0}};
static const struct scene_rule sphere_keys[] = {
    {"centre", SCENE_LIST, "m", .required = true, .length = 3, .inside = &scene_number,
     .about = "its middle"},
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE, .about = "of a ball"},
    MOVES,
    {0}};
static const struct scene_rule box_keys[] = {
    {"centre", SCENE_LIST, "m", .required = true, .length = 3, .inside = &scene_number,
     .about = "its middle"},
    {"size", SCENE_LIST, "m", .required = true, .length = 3, .inside = &scene_positive,
     .about = "lengths of its edges, before it is rotated"},
    {"rotate", SCENE_LIST, .fallback = "[1, 0, 0, 0]", .length = 4, .inside = &scene_number,
     .about = "about its centre: a quaternion [w, x, y, z]"},
    MOVES,
    {0}};
static const struct scene_rule capsule_keys[] = {
    {"from", SCENE_LIST, "m", .required = true, .length = 3, .inside = &scene_number,
     .about = "one end of the line in its middle"},
    {"to", SCENE_LIST, "m", .required = true, .length = 3, .inside = &scene_number,
     .about = "the other end"},
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     .about = "around the line and its ends"},
    MOVES,
    {0}};
static const struct scene_rule cylinder_keys[] = {
    {"centre", SCENE_LIST, "m", .required = true, .length = 3, .inside = &scene_number,
     .about = "its middle"},
    {"axis", SCENE_LIST, .required = true, .length = 3, .inside = &scene_number,
     .about = "from one end to the other, of any length but 0"},
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     .about = "around the axis"},
    {"length", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     .about = "from end to end; a short one is a disc"},
    MOVES,
    {0}};
static const struct scene_rule frames_keys[] = {
    {"pc2", SCENE_TEXT, .choice = true,
     .about = "a PC2 file (version 1, Blender's Mesh Cache) of the mesh's vertices, relative to "
     "the scene's folder"},
    {"obj", SCENE_LIST, .choice = true, .filled = true, .inside = &scene_text,
     .about = "OBJ files with the mesh's faces, one a frame"},
    {"fps", SCENE_NUMBER, "1/s", "25", .range = SCENE_POSITIVE, .about = "frames a second"},
    {"start", SCENE_NUMBER, "s", "0", .about = "when the first frame is"},
    {0}};
const struct model_word scene_meets[] = {{"bvh", false}, {"image", true}, {0}};
const struct model_word scene_views[] = {
    {"thinnest", CONTACT_THINNEST}, {"x", 0}, {"y", 1}, {"z", 2}, {0}};
static const struct scene_rule body_keys[] = {
    {"obj", SCENE_TEXT, .choice = true,
     .about = "an OBJ file of a closed mesh, relative to the scene's folder"},
    {"mannequin", SCENE_MAP, .choice = true, .inside = scene_mannequin_keys, .apart = true,
     .about = "a standing figure, made to measure",
     SECTION("A figure", "The figure stands with its arms held aside, and has the girths of "
     "`measures`; [garments.md](garments.md#the-body) has defaults, ranges and a picture. By "
     "`walk` it walks on the spot, by `poses` it goes from pose to pose.",
     "obstacles:\n"
     "  - body: {mannequin: {height: 1.68, measures: {chest: 0.92, waist: 0.74}, walk: {speed: "
     "2, begin: 0.5}}, name: figure}\n"
     "  - body: {mannequin: {poses: [{time: 0}, {time: 1, left_arm_aside: 80, right_knee_bend: "
     "20}]}}\n")},
    TRANSFORM(struct mesh_transform, ),
    {"meet", SCENE_CHOICE, .fallback = "bvh", .words = scene_meets,
     .about = "bvh: its triangles, found by a tree of boxes; image: maps of it, from the front "
     "and the back, not by contact.mode certified",
     SECTION("Bodies that are met by image",
     "With `meet: image` cloth meets two pictures of the body, its front and its back, after "
     "Vassilev, Spanlang & Chrysanthou (2001). A pixel has the depth, the normal and the "
     "velocity of the surface that it shows. Each vertex looks in its pixel for whether it is "
     "inside, whatever the size of the body's mesh.\n\n"
     "A vertex between front and back is inside, and leaves through the nearer of the two. So "
     "all that lies behind the front and before the back is solid: an arm before the chest and "
     "the room between them, or the legs seen from the side. At armpits and at the crotch cloth "
     "that belongs there is put out. Sides that lie along the view are not seen: what enters a "
     "box through one of them leaves by its front or back. A vertex beside the outline by less "
     "than a pixel may count as inside, or not. Choose the `view` in which the body hides least "
     "of itself: for a figure that stands with its arms aside, from the front.\n\n"
     "Nothing of this is proven, so `certified` contact with such a body is an error, and a "
     "scene that has one and gives no `contact.mode` has `project`. The pictures of a body that "
     "stands still or follows a `motion` are made once; those of a body with `frames` in each "
     "step. Pictures of a figure of 27,732 triangles, 626 x 1024 pixels, take 7 ms on two "
     "threads, and a vertex about 15 ns.",
     "obstacles:\n"
     "  - body: {obj: figure.obj, scale: 0.1, meet: image, view: z, resolution: 512}\n")},
    {"resolution", SCENE_INTEGER, .fallback = "1024", .min = CONTACT_LEAST_RESOLUTION,
     .max = CONTACT_MOST_RESOLUTION,
     .about = "pixels along the longer side of the maps; a pixel takes 32 bytes, of a body with "
     "frames 56, on every rank", .needs = "meet = image"},
    {"view", SCENE_CHOICE, .fallback = "thinnest", .words = scene_views,
     .about = "the axis along which the maps see the body before it moves; thinnest: that of its "
     "least extent", .needs = "meet = image"},
    {"frames", SCENE_MAP, .inside = frames_keys,
     .about = "where its vertices are in time, before scale, rotate and translate; linear "
     "between frames",
     .more = "Frames have as many vertices as the mesh, which only says how they are joined. "
     "Before the first and after the last one the body rests. A vertex that jumps by more than a "
     "quarter of the body's size from one frame to the next draws a warning. A body has `frames` "
     "or a `motion`. The folder of `--output` has its vertices in each frame, `body-0.pc2` and "
     "so on, which `duite-view` reads."},
    MOVES,
    {0}};
const struct scene_rule scene_body = {.type = SCENE_MAP, .inside = body_keys};
static const struct scene_rule obstacle_kinds[] = {
    {"plane", SCENE_MAP, .inside = plane_keys,
     .about = "a floor or wall; two that stand still, face each other and overlap are an error"},
    {"sphere", SCENE_MAP, .inside = sphere_keys, .about = "a ball"},
    {"box", SCENE_MAP, .inside = box_keys, .about = "a block"},
    {"capsule", SCENE_MAP, .inside = capsule_keys, .about = "a rod with round ends"},
    {"cylinder", SCENE_MAP, .inside = cylinder_keys, .about = "a rod with flat ends, or a disc"},
    {"body", SCENE_MAP, .inside = body_keys, .apart = true,
     .about = "a closed mesh",
     SECTION("Bodies",
     "The mesh of a `body` is in metres after its `scale`; its faces are counterclockwise as "
     "seen from outside. Each of its edges has two triangles: a mesh with a hole, or with an "
     "edge of three, is an error that names the vertices. So are faces that are wound against "
     "each other, a triangle without area, two triangles that lie on each other, and a mesh that "
     "holds no room. A mesh that is inside out is turned round, with a warning. A part of it "
     "that is inside out must be a hole in another part. Polygons are cut into triangles as a "
     "cloth's, but twisted ones are fanned from their first corner. Edges without faces (`l`) "
     "are not read.\n\n"
     "A body of more than 10 m, or less than 1 cm, draws a warning, as its mesh may not be in "
     "metres. So does a body that goes through itself where the run starts, with the number of "
     "such pairs of triangles and the first of them; cloth can be pinched there. Parts that lie "
     "in each other without being holes are not looked for. In both cases the nearest triangle "
     "decides what is inside.\n\n"
     "`duite-view` draws a body by the mesh that the run leaves beside the frames, `body-0.obj` "
     "and so on. A scene that reads a file of the folder of `--output`, which the run would "
     "replace, is refused.",
     "obstacles:\n"
     "  - body: {obj: figure.obj, name: figure, frames: {pc2: figure.pc2, fps: 25}}\n")},
    {0}};
const struct scene_rule scene_obstacle = {.type = SCENE_ONE_OF, .inside = obstacle_kinds};
