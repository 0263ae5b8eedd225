/* Keys of contact. */
#include "cloth/scene/schema/tables.h"

/* clang-format off */
static const struct scene_rule pair_keys[] = {
    {"of", SCENE_LIST, .required = true, .length = 2, .inside = &scene_text,
     .about = "names of materials or obstacles; a cloth with `regions` goes by its own material"},
    {"friction", SCENE_NUMBER, .required = true, .range = SCENE_COEFFICIENT,
     INTO(struct model_rub, friction),
     .about = "coefficient of the two"},
    {0}};
static const struct scene_rule pair = {.type = SCENE_MAP, .inside = pair_keys};
static const struct scene_rule ignored = {.type = SCENE_LIST, .length = 2, .inside = &scene_text};
const struct scene_section scene_contact_section = {"Contact",
    "By `project` a vertex that ended a step in an obstacle is put out, and its normal velocity "
    "v becomes max(v, that of the surface); cloth goes through cloth. By `certified` nothing "
    "goes through anything, edges and triangles included, and what touches rubs "
    "([physics.md](physics.md#certified-contact)): contact is in the solve of implicit steps, "
    "and a step ends only where it is proven that nothing went through. Else it is solved again, "
    "vertices are cut back, or it is halved. Where nothing meets anything it takes no time. "
    "`repulsion` is the cheap way between, of all integrators: springs push apart what is nearer "
    "than `thickness` where a step begins ([physics.md](physics.md#repulsion)). It promises "
    "nothing: what is fast for its springs goes through, and cloth that went through cloth is "
    "held on the wrong side.\n\n"
    "A scene that gives no `mode` has `certified` contact if there is more to touch than planes: "
    "several cloths that have triangles, a cloth with `self: on`, or an obstacle other than a "
    "plane. Otherwise it has `project`; so have explicit integrators, scenes with a body that is "
    "met by image, and scenes where edges without triangles (chains) could meet obstacles, since "
    "a certificate is of triangles. The run's summary and the report (`contact_mode`) say "
    "which.\n\n"
    "- The start of a `certified` run must be free: cloth that touches cloth or an obstacle "
    "there is an error, which counts the pairs and names the first of them; or `untangle: on` "
    "makes it free.\n"
    "- Take a `thickness` below the mesh's edges, and start at least as far apart. The finer the "
    "mesh, the smaller it has to be.\n"
    "- Many `contact_solves` or `steps_halved_contact` in the report ask for a shorter `time.h`. "
    "`contacts` are the most that were near at a time.\n"
    "- Pins and obstacles go where they are led. The run ends with an error where they leave "
    "cloth no room.\n"
    "- Chains and other edges without triangles meet nothing by `certified` and `repulsion`; by "
    "`project` their vertices meet obstacles.\n"
    "- By `repulsion` take an h in which nothing goes farther than `thickness`, and look at "
    "frames by `--check-intersections`.\n"
    "- A feature on a weld of several cloths, all corners of which are welded, counts as one of "
    "the cloth that comes first.\n\n"
    "These scenes of `cloth/scenes` have certified contact, and `--check-intersections` finds "
    "none in their frames. `slope.yaml` has friction, too.\n\n"
    "| | |\n"
    "|---|---|\n"
    "| ![A red sheet hangs in folds around a ball](pictures/sphere.png) | ![Five sheets, each "
    "turned against the one below, fall onto each other](pictures/stack.png) |\n"
    "| `sphere.yaml`: a sheet of 150 x 150 vertices falls onto a ball; `--camera=35,20,1.4` | "
    "`stack.yaml`: five sheets fall onto each other; `--frame 3 --camera=30,20,1.3` |\n"
    "| ![A sheet twisted to a rope, with folds in folds](pictures/twist.png) | ![A round cloth "
    "hangs over a disc in soft folds](pictures/drape.png) |\n"
    "| `twist.yaml`: a sheet is wrung by its ends, three turns; `--frame 62 --camera=0,10,1.8` | "
    "`drape.yaml`: the [drape test](#the-drape-test); `--camera=30,12` |\n"
    "| ![Two patches on a slope, the smooth one further down](pictures/slope.png) | |\n"
    "| `slope.yaml`: friction holds one cloth, the other slides; `--camera=15,25,0.8` | |\n\n"
    "```sh\n"
    "duite-cloth twist.yaml --output wrung\n"
    "duite-view wrung --frame 62 --camera=0,10,1.8 --size 640x400 --png twist.png\n"
    "```",
    "schema: 1\n"
    "name: two sheets\n"
    "cloths:\n"
    "  - name: lower                  # falls onto the floor\n"
    "    mesh: {grid: {width: 0.3, height: 0.3, nx: 31, ny: 31}}\n"
    "    transform: {translate: [0, 0.01, 0]}\n"
    "    material: cotton\n"
    "  - name: upper                  # falls onto both\n"
    "    mesh: {grid: {width: 0.3, height: 0.3, nx: 31, ny: 31}}\n"
    "    transform: {translate: [0.1, 0.05, 0.1]}\n"
    "    material: cotton\n"
    "materials:\n"
    "  cotton: {density: 0.2, stretch: 1000, shear: 300, bend: 1, friction: 0.4, damping: "
    "{stiffness: 0.004}}\n"
    "obstacles:\n"
    "  - plane: {point: [0, 0, 0], normal: [0, 1, 0], friction: 0.5}\n"
    "contact:\n"
    "  mode: certified\n"
    "  self: on                       # each cloth meets itself, too\n"
    "  thickness: 0.002               # m: so far apart is what rests on something\n"
    "time: {h: 0.005, end: 0.5, fps: 25}\n"};
const struct scene_rule scene_contact_keys[] = {
    {"mode", SCENE_CHOICE, INTO(struct model_contact, mode), .words = model_contact_modes,
     .about = "certified: in the solve, and no step ends where a contact is not proven; "
     "repulsion: springs push apart what is too near; project: vertices in obstacles are put out "
     "after the step; else certified in implicit steps where there is more to touch than planes",
     .more = "`certified` needs an implicit integrator."},
    {"self", SCENE_CHOICE, .fallback = "off", INTO(struct model_contact, self),
     WORDS({"on", true}, {"off", false}),
     .about = "a cloth touches itself, too; different cloths always touch", .needs = NEEDS_MET},
    {"untangle", SCENE_CHOICE, .fallback = "off", INTO(struct model_contact, untangle),
     WORDS({"on", true}, {"off", false}),
     .about = "cloths that start in each other or in obstacles are moved apart",
     .needs = NEEDS_CERTIFIED,
     SECTION("Starts that are tangled",
     "Cloth that starts in cloth, in itself or in an obstacle, or nearer to it than a tenth of "
     "the thickness, is moved out before the first step; by `off` such a run is refused. It has "
     "no part in the motion: velocities, masses and shapes at rest stay, vertices start "
     "elsewhere. Pinned vertices stay where they are. Free cloth keeps every bit.\n\n"
     "- *Obstacles.* Vertices go out the nearest way.\n"
     "- *Layers.* A cloth of a higher `layer` goes to the outside of those of lower ones, where "
     "it has vertices within 30 thicknesses of them. Out is where the inner cloth's triangles "
     "are seen counterclockwise from. Cloth that lies wholly on the wrong side goes through, "
     "too.\n"
     "- *Equal layers, and a cloth with itself.* Cloth that pokes through goes back: of the "
     "parts into which the crossings cut a cloth, all but the largest are on the wrong side. "
     "Where two cloths cross up to their borders, the side where most of them is counts. So "
     "nothing needs to be said where less than half of a cloth went through by less than 30 "
     "thicknesses.\n"
     "- *Edges* change their length by a fifth, where they can.\n\n"
     "It takes rounds, of about 0.15 s for 20,000 vertices, until the check of "
     "`--check-intersections` finds nothing. Two sheets that cross from one end to the other, or "
     "pins that are in each other, are an error that names the first pairs. The report has "
     "`untangle_rounds`, `untangle_vertices` (moved) and `untangle_largest` (m, the largest "
     "move). Joints of `length: start` have the length that they have then. "
     "[physics.md](physics.md#certified-contact) has the method.",
     "contact: {mode: certified, self: on, thickness: 0.002, untangle: on}\n"
     "cloths:\n"
     "  - {name: shirt, material: cotton, mesh: {file: shirt.obj}, layer: 1}\n"
     "  - {name: jacket, material: denim, mesh: {file: jacket.obj}, layer: 2}   # outside of the "
     "shirt\n")},
    {"force", SCENE_CHOICE, .fallback = "off", INTO(struct model_contact, force),
     WORDS({"on", true}, {"off", false}),
     .about = "frames have the force of contact on each vertex, in contact.pc2",
     .more = "`DIR/contact.pc2` is a PC2 cache as `cloth.pc2` is, with forces (N) in the place "
     "of positions; `duite-view --colour contact` draws them.", .needs = NEEDS_CERTIFIED},
    {"thickness", SCENE_NUMBER, "m", "0.001", .range = SCENE_POSITIVE,
     INTO(struct model_contact, thickness),
     .about = "how near to each other what touches is",
     .more = "Edges of triangles are longer at rest, but for few: both ends of a short one count "
     "as one for contact, whose triangles do not meet each other, and a warning names the "
     "shortest. That is so where at most a tenth of the edges is short and what these join fits "
     "into 4 thicknesses. By `certified` it is at least 2.1e-6 of the largest coordinate, so "
     "that frames, which are in float, keep apart what is a tenth of it apart.",
     .needs = NEEDS_MET},
    {"pressure", SCENE_NUMBER, "Pa", "5000", .range = SCENE_POSITIVE,
     INTO(struct model_contact, pressure),
     .about = "by which the thickness of cloth without room is half of it",
     .more = "Cloth has no room where obstacles, or what else it touches, leave less than its "
     "thickness. There it pushes with a force that does not depend on time.h: this pressure "
     "times thickness / gap - 1 times its area ([physics.md](physics.md#certified-contact)). "
     "Fabrics lose a third to a half of their thickness by the 4.9 kPa of KES-C. "
     "`contact_pinches` of the report counts such contacts.",
     .needs = NEEDS_CERTIFIED},
    {"friction", SCENE_NUMBER, .fallback = "0", .range = SCENE_COEFFICIENT,
     INTO(struct model_contact, friction),
     .about = "coefficient of materials and obstacles that give none; sides a and b: sqrt(a b)",
     .needs = NEEDS_MET},
    {"pairs", SCENE_LIST, .fallback = "[]", .max = SCENE_MOST_NAMED, .inside = &pair,
     ARRAY(struct model_contact, pairs, n_pairs),
     .about = "two sides with a friction of their own, in place of sqrt(a b)", .needs = NEEDS_MET},
    {"ignore", SCENE_LIST, .fallback = "[]", .max = SCENE_MOST_NAMED, .inside = &ignored,
     .about = "[A, B]: cloths, obstacles or groups that do not meet", .needs = NEEDS_MEETINGS,
     SECTION("What does not meet", "A and B are each the name of a cloth, of an obstacle or of a "
     "group (`groups` of cloths and obstacles); a name that several have means all of them. A "
     "cloth that is named twice does not meet itself. Such pairs are left out in all modes: by "
     "the certificates, the check of the start and `--check-intersections`, also that of "
     "`duite-view` in the frames of a folder (`scene.json` has the pairs).",
     "cloths:\n"
     "  - {name: coat, groups: [worn], material: denim, mesh: {file: coat.obj}}\n"
     "  - {name: veil, groups: [worn], material: silk, mesh: {file: veil.obj}}\n"
     "obstacles:\n"
     "  - body: {obj: figure.obj, name: figure}\n"
     "  - sphere: {centre: [0, 0, 0], radius: 0.1, groups: [props]}\n"
     "contact:\n"
     "  pairs:\n"
     "    - {of: [silk, figure], friction: 0.15}     # a material on an obstacle\n"
     "  ignore:\n"
     "    - [veil, figure]\n"
     "    - [worn, props]\n"
     "    - [veil, veil]\n")},
    {"stiffness", SCENE_NUMBER, "N/m", .range = SCENE_POSITIVE,
     INTO(struct model_contact, stiffness),
     .about = "force by which a contact pushes apart, for each metre that is missing of the "
     "thickness; else by mass and time.h",
     .more = "Without it: 0.1 m / h^2 by explicit integrators, and by implicit ones the larger "
     "of 0.03 `stretch` and 4 m / h^2 (means of the cloths; m: mass of a vertex).",
     .needs = NEEDS_REPULSION},
    {"damping", SCENE_NUMBER, .fallback = "0.2", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_contact, damping),
     .about = "part of the critical damping of a vertex of mean mass on one contact",
     .needs = NEEDS_REPULSION},
    {0}};
