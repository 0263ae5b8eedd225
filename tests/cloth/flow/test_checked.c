/* Every kernel of the flow in checking mode, where bodies run on guarded copies, twice, with
 * different bytes under what they overwrite: small scenes in several blocks, each with another part
 * of the model. The linker puts the function below in the place of the one that calls bodies
 * (module.mk), so the last case knows which kernels no scene has run. Messages between ranks are
 * seen on two of them (test_ranks.sh).
 *
 *   test_checked [quick|long]
 *
 * long: all pairs of what there is to choose (test_checked_long.sh); by default each choice at
 * least once; quick, also with DUITE_QUICK=1: so much that each kernel runs. */
#include "runtime/check/check.h"
#include "tests/cloth/flow/checked_runs.h"

#include <stdlib.h>
#include <sys/mman.h>

/* ---- Which kernels ran ---- */

enum { MAX_KERNELS = 128 };
static unsigned char *ran; /* of MAX_KERNELS; shared with the processes of the cases */

int __real_check_call(struct check *check, const struct check_task *task, duite_call *call);
int __wrap_check_call(struct check *check, const struct check_task *task, duite_call *call);

int __wrap_check_call(struct check *check, const struct check_task *task, duite_call *call)
{
    const duite_kernel *const *all = flow_kernels();
    for (size_t i = 0; all[i]; i++)
        if (all[i] == task->kernel)
            __atomic_store_n(ran + i, 1, __ATOMIC_RELAXED);
    return __real_check_call(check, task, call);
}

/* ---- Cases ---- */

/* The choices of scenes, as sets of their words. */
enum { MOST_CHOICES = 16, CHOICE_TEXT = 48 };
struct choices {
    size_t n;
    char set[MOST_CHOICES][CHOICE_TEXT];
};
static struct choices integrators, preconditioners;
static size_t n_implicit; /* of the integrators, which come first */

/* Before any test, which might say that there is no room. */
static void choices_add(struct choices *choices, const char *key, const char *word)
{
    if (choices->n == MOST_CHOICES)
        abort();
    snprintf(choices->set[choices->n++], CHOICE_TEXT, "%s=%s", key, word);
}

static void choices_find(void)
{
    for (int is_explicit = 0; is_explicit < 2; is_explicit++)
        for (const struct model_word *word = model_integrators; word->word; word++)
            if (is_explicit == (model_schemes[word->value].limit != NULL)) {
                choices_add(&integrators, "integrator", word->word);
                n_implicit += !is_explicit;
            }
    for (const struct model_word *word = model_preconditioners; word->word; word++)
        choices_add(&preconditioners, "solver.preconditioner", word->word);
}

static const char *const none = "solver.preconditioner=none";
static const char *const ic0_coarse = "solver.preconditioner=ic0_coarse";
static const char *const formats[] = {"solver.format=springs", "solver.format=half"};
static const char *const newton = "newton={steps: 2, tolerance: 1e-9}";

#define LENGTH(list) (sizeof(list) / sizeof *(list))

static bool whole;

/* True if choice i of n is run with choice k of m: without the long test each with one other. */
static bool paired(size_t i, size_t n, size_t k, size_t m)
{
    return whole || (n < m ? k % n == i : i % m == k);
}

UNIT_FIXTURE(sample, sample_no_more)

UNIT_TEST(materials)
{
    static const char *const all[] = {
        "cloths[0].material=springs",   "cloths[0].material=undamped",
        "cloths[0].material=hinges",    "cloths[0].material=quadratic",
        "cloths[0].material=triangles", "cloths[0].material=uncorrected"};
    sample_no_more();
    for (size_t i = 0; i < integrators.n; i++)
        for (size_t k = 0; k < LENGTH(all); k++)
            if (paired(i, integrators.n, k, LENGTH(all)))
                run(SETS(integrators.set[i], all[k]));
}

UNIT_TEST(pins)
{
    static const char *const all[] = {
        "cloths[0].pins=[]",
        "cloths[0].pins[0].motion={times: [0, 1], translate: [[0, 0, 0], [0, 0.3, 0]]}",
        "cloths[0].pins=[{box: [[-1, -1, -0.6], [1, 1, -0.4]], to: line, direction: [1, 0, 0]}]",
        "cloths[0].pins=[{vertices: [0, 35], to: plane, normal: [1, 2, 0]}]",
        ("cloths[0].pins=[{vertices: [0, 35], to: plane, normal: [1, 2, 0], motion: "
         "{times: [0, 1], rotate: [[1, 0, 0, 0], [0.8, 0, 0.6, 0]]}}]"),
    };
    sample_no_more();
    for (size_t i = 0; i < integrators.n; i++)
        for (size_t k = 0; k < LENGTH(all); k++)
            if (paired(i, integrators.n, k, LENGTH(all)))
                run(SETS(integrators.set[i], all[k]));
}

UNIT_TEST(contact)
{
    for (size_t i = 0; i < n_implicit; i++)
        for (size_t k = 0; k < LENGTH(formats); k++)
            if (paired(i, n_implicit, k, LENGTH(formats)))
                run(SETS(integrators.set[i], formats[k],
                         k % 2 ? "cloths[0].material=triangles" : NULL));
    run(SETS("obstacles=[]"));
}

static void solves(const char *of)
{
    for (size_t i = 0; i < LENGTH(formats); i++)
        for (size_t k = 0; k < preconditioners.n; k++) {
            if (!paired(i, LENGTH(formats), k, preconditioners.n))
                continue;
            run(SETS(of, formats[i], preconditioners.set[k]));
            run(SETS(of, formats[i], preconditioners.set[k], "solver.guess=zero",
                     "cloths[0].material=hinges"));
        }
}

UNIT_TEST(solves_of_one_reduction)
{
    solves(NULL);
}

UNIT_TEST(solves_of_newton_steps)
{
    solves(newton);
}

UNIT_TEST(filtered_solves)
{
    for (size_t i = 0; i < preconditioners.n; i++) {
        if (paired(i, preconditioners.n, 0, 2))
            run(SETS("cloths[0].pins=[{vertices: [0, 35], to: line, direction: [1, 2, 0]}]",
                     preconditioners.set[i]));
        if (paired(i, preconditioners.n, 1, 2))
            run(SETS(newton, "cloths[0].pins=[{vertices: [0, 35], to: plane, normal: [1, 2, 0]}]",
                     preconditioners.set[i]));
    }
}

UNIT_TEST(other_solves)
{
    static const char *const all[] = {"solver.stop={mass_norm: 0.01}",
                                      "solver.patches=1",
                                      "solver.patches=4",
                                      "solver.jacobian=full",
                                      "solver.jacobian=absolute",
                                      "solver.stop={relative: 1e-9}",
                                      "solver.stop={count: 7}",
                                      "solver.stop={absolute: 1e-3}",
                                      "solver.stop={normalised: 0.001}"};
    for (size_t i = 0; i < LENGTH(all); i++)
        for (size_t k = 0; k < 2; k++)
            if (paired(i, LENGTH(all), k, 2))
                run(SETS(all[i], k ? ic0_coarse : none, "cloths[0].mesh.grid.nx=7"));
}

UNIT_TEST(outside)
{
    static const char *const load = "cloths[0].loads=[{vertices: [20], force: [0, 1, 0], curve: "
                                    "{sine: {frequency: 5}}}, {edges: [[0, 1]], force: [1, 0, 0], "
                                    "curve: {keys: [[0, 0], [1, 1]]}}, {vertices: [9], force: [0, "
                                    "0, 1]}]";
    for (size_t i = 0; i < integrators.n; i++) {
        if (paired(i, integrators.n, 0, 2))
            run(SETS(integrators.set[i], load));
        if (paired(i, integrators.n, 1, 2))
            run(SETS(integrators.set[i], load,
                     "air={wind: [1, 2, 3], curve: {sine: {frequency: 1}}}",
                     "cloths[0].material=triangles"));
    }
}

UNIT_TEST(cloths)
{
    static const char *const all[] = {
        "cloths[0].mesh={inline: {vertices: [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [9, 9, "
        "9]], edges: [[0, 1], [1, 2], [2, 3]]}}",
        "cloths[0].mesh={inline: {vertices: [[0, 0, 0], [1, 0, 0], [0, 0, 1]], triangles: [[0, 1, "
        "2]]}}",
        "cloths[0].regions=[{box: [[-1, -1, 0], [1, 1, 1]], material: undamped}]",
        "cloths[0].masses=[{vertices: [3], mass: 0.1}]",
        "cloths[0].mass_per_vertex=0.1",
        "cloths[0].start=[{vertices: [3, 4], velocity: [0, 0, 1], spin: [0, 2, 0]}]",
        "cloths[1]={mesh: {grid: {width: 1, height: 1, nx: 2, ny: 3}}, material: triangles, "
        "transform: {translate: [0, 3, 0]}}"};
    static const char *const grains[] = {"grain=1", "grain=2", "grain=8", "grain=100"};
    int rank, ranks;
    record_mpi(&rank, &ranks);
    for (size_t i = 0; i < LENGTH(all); i++) {
        const bool small = i < 2;
        for (size_t k = small ? 0 : 2; k < (small ? 2 : 4); k++)
            if ((k < 3 || ranks == 1) && paired(i, LENGTH(all), k % 2, 2))
                run(SETS(all[i], grains[k], small ? "cloths[0].material=undamped" : NULL,
                         small ? "cloths[0].mass_per_vertex=0.1" : NULL, "probes=[]"));
    }
}

/* Shapes at rest that change in time, and pins that give. */
UNIT_TEST(sizes)
{
    static const char *const springs = "materials.springs.size={warp: [[0, 1], [0.002, 0.9]]}";
    static const char *const triangles = "materials.triangles.size={both: [[0, 1], [0.002, 1.1]]}";
    static const char *const soft =
        "cloths[0].pins=[{vertices: [0, 5], stiffness: 5, damping: 0.1}]";
    for (size_t i = 0; i < integrators.n; i++)
        run(SETS(integrators.set[i], springs, i % 2 ? soft : NULL));
    run(SETS("cloths[0].material=triangles", triangles, soft));
}

/* Joints that are there in the first step, that begin in the second one, and that end before it. */
UNIT_TEST(timed_joints)
{
    static const char *const joints =
        "joints=[{from: {vertices: [1, 2, 3]}, to: {vertices: [34, 33, 2]}, stiffness: 5, damping: "
        "0.01, end: 0.0015}, {from: {vertex: 5}, to: {vertex: 30}, stiffness: 5, begin: 0.001}, "
        "{from: {vertex: 0}, to: {vertex: 35}, stiffness: 5, length: 0, end: 0.001}]";
    for (size_t i = 0; i < integrators.n; i++)
        run(SETS(integrators.set[i], joints, i % 2 ? "cloths[0].pins=[]" : NULL));
    for (size_t i = 0; i < LENGTH(formats); i++)
        for (size_t k = 0; k < preconditioners.n; k++)
            if (paired(i, LENGTH(formats), k, preconditioners.n))
                run(SETS(joints, formats[i], preconditioners.set[k],
                         k % 2 ? "solver.guess=previous" : "newton.steps=2"));
    run_how(&(struct how){.system = true}, SETS(joints));
    run_how(&(struct how){.system = true}, SETS(joints, "cloths[0].material=hinges"));
}

/* Scenes that give a step up and begin it again with half its length. */
UNIT_TEST(halved_steps)
{
    for (size_t i = 0; i < integrators.n; i++) {
        struct how how = {0};
        if (!paired(i, integrators.n, 0, 3))
            continue;
        if (run_how(&how, SETS(integrators.set[i], "time.stretch_growth=0.004", "time.end=0.001",
                               "cloths[0].start=[{vertices: [20], velocity: [9, 0, 0]}]")))
            ck_assert_uint_gt(how.report.steps_halved, 0);
    }
}

UNIT_TEST(cut_newton_steps)
{
    for (size_t i = 0; i < (whole ? n_implicit : 1); i++)
        run(SETS(integrators.set[i], "newton={steps: 5, tolerance: 1e-9}",
                 "time={h: 0.05, end: 0.1}", "time.halving=off",
                 "materials.springs={density: 0.2, stretch: 5000, shear: 10}",
                 "cloths[0].start=[{vertices: [20], velocity: [50, 0, 0]}]"));
}

UNIT_TEST(saved_systems)
{
    struct how how = {.system = true};
    for (size_t i = 0; i < LENGTH(formats); i++)
        run_how(&how, SETS(formats[i], i ? "cloths[0].material=hinges" : NULL));
}

UNIT_TEST(rests)
{
    run(SETS("time.rest={speed: 0.1, hold: 0.001}", "gravity=[0, 0, 0]",
             "cloths[0].velocity=[0, 0, 0]", "time.end=0.01"));
}

static const char box[] = "v -1 0 -1\nv 1 0 -1\nv -1 1 -1\nv 1 1 -1\nv -1 0 1\nv 1 0 1\n"
                          "v -1 1 1\nv 1 1 1\nf 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\n"
                          "f 1 3 4 2\nf 5 6 8 7\n";

/* Bodies that are met by maps: one that moves, and one that changes its shape. */
UNIT_TEST(maps)
{
    static const char wide[] = "v -1 0 -1\nv 2 0 -1\nv -1 1 -1\nv 1 2 -1\nv -1 0 1\nv 1 0 1\n"
                               "v -1 1 1\nv 1 1 1\nf 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\n"
                               "f 1 3 4 2\nf 5 6 8 7\n";
    static const char *const moves =
        "obstacles[1]={body: {obj: box.obj, scale: 0.2, translate: [0, -0.2012, 0], meet: image, "
        "resolution: 20, motion: {times: [0, 1], translate: [[0, 0, 0], [0, 0.1, 0]]}}}";
    static const char *const changes =
        "obstacles[2]={body: {obj: box.obj, scale: 0.3, translate: [0.2, -0.301, 0], meet: image, "
        "view: y, resolution: 33, frames: {obj: [box.obj, wide.obj], fps: 1}}}";
    scene_write_file("box.obj", box, sizeof box - 1);
    scene_write_file("wide.obj", wide, sizeof wide - 1);
    for (size_t i = 0; i < integrators.n; i++)
        if (paired(i, integrators.n, 0, 3))
            run(SETS(integrators.set[i], moves, changes, "contact.mode=project"));
}

/* A plane, cloth on cloth, and a body that comes from below; a solve that ends early leaves ways to
 * cut. */
UNIT_TEST(certified_contact)
{
    static const char *const mode =
        "contact={mode: certified, self: on, force: on, thickness: 0.0005, friction: 0.3}";
    static const char *const body = "obstacles[1]={body: {obj: box.obj, scale: 0.2, translate: "
                                    "[0, -0.2012, 0], motion: {times: [0, 1], translate: "
                                    "[[0, 0, 0], [0, 0.1, 0]]}}}";
    static const char *const above =
        "cloths[1]={mesh: {grid: {width: 1, height: 1, nx: 3, ny: 3}}, material: triangles, "
        "velocity: [0, -3, 0], transform: {translate: [0.1, 0.001, 0.1]}}";
    static const char *const probes =
        "probes=[{cloth: sheet, vertices: [0], values: [contact, contact_total]}, {obstacle: 1}]";
    scene_write_file("box.obj", box, sizeof box - 1);
    for (size_t i = 0; i < n_implicit; i++)
        run(SETS(integrators.set[i], mode, body, above, probes,
                 i ? "solver.stop={count: 1}" : NULL));
}

/* No push and no cut parts pinned cloth from a body that hits it. */
UNIT_TEST(hopeless_contact)
{
    static const char *const hits = "obstacles[1]={body: {obj: box.obj, scale: 0.2, translate: "
                                    "[0, -0.2012, 0], motion: {times: [0, 1], translate: "
                                    "[[0, 0, 0], [0, 30, 0]]}}}";
    scene_write_file("box.obj", box, sizeof box - 1);
    run_how(&(struct how){.ends = "cannot be kept apart"},
            SETS("integrator=implicit_euler", "contact={mode: certified, thickness: 0.0005}", hits,
                 "time.halving=off", "cloths[0].pins=[{box: [[-9, -9, -9], [9, 9, 9]]}]",
                 "probes=[]"));
}

/* A plane, and cloth on cloth. */
UNIT_TEST(repulsion)
{
    static const char *const mode = "contact={mode: repulsion, self: on, thickness: 0.002, "
                                    "friction: 0.3}";
    static const char *const above =
        "cloths[1]={mesh: {grid: {width: 1, height: 1, nx: 3, ny: 3}}, material: triangles, "
        "velocity: [0, -3, 0], transform: {translate: [0.1, 0.001, 0.1]}}";
    for (size_t i = 0; i < integrators.n; i++)
        if (whole || i % 2 == 0)
            run(SETS(integrators.set[i], mode, above, "probes=[]"));
}

/* Rows on a slider and held ones, edges within blocks and between them. */
UNIT_TEST(velocity_correction)
{
    for (size_t i = 0; i < integrators.n; i++)
        if (whole || i % 2 == 0)
            run(SETS(integrators.set[i], "materials.springs.velocity_correction={at: 0, rounds: 5}",
                     "cloths[0].start=[{vertices: [20], velocity: [9, 0, 0]}]"));
}

/* A run that makes checkpoints, and one that goes on from the last of them: plain, with contacts,
 * with ties. */
UNIT_TEST(checkpoints)
{
    static const char *const mode = "contact={mode: certified, self: on, thickness: 0.0005}";
    static const char *const joint =
        "joints=[{from: {vertex: 3}, to: {vertex: 20}, stiffness: 5, begin: 0.001}]";
    static const char *const beside = "output={hdf5: {fields: [velocity, block, rank]}}";
    const char *more[] = {mode, joint, NULL};
    for (size_t i = 0; i < sizeof more / sizeof *more; i++) {
        struct how first = {.saves = true}, next = {0};
        asked = 0; /* both are run */
        run_how(&first, SETS(beside, more[i]));
        next.from = first.saved;
        asked = 0;
        run_how(&next, SETS(beside, "time.end=0.004", more[i]));
        free(first.saved.bytes);
    }
}

UNIT_TEST(pulled_seams)
{
    for (size_t i = 0; i < integrators.n; i++)
        run(SETS(integrators.set[i], "cloths[0].mesh={pattern: {garment: skirt, edge: 0.15}}",
                 "cloths[0].pins=[]", "cloths[0].material=triangles",
                 "cloths[0].seams={state: pulled, stiffness: 5, damping: 0.01}"));
}

/* So many blocks that groups of them solve the coarse part. */
UNIT_TEST(groups)
{
    run(SETS("cloths[0].mesh.grid.nx=30", "cloths[0].mesh.grid.ny=30", "grain=6",
             "solver.patches=2", "time.end=0.001", ic0_coarse));
}

/* ---- All kernels ---- */

UNIT_TEST(every_kernel_was_run)
{
    const duite_kernel *const *all = flow_kernels();
    char names[1024] = "";
    int rank, ranks;
    record_mpi(&rank, &ranks);
    MPI_Allreduce(MPI_IN_PLACE, ran, MAX_KERNELS, MPI_UNSIGNED_CHAR, MPI_MAX, MPI_COMM_WORLD);
    for (size_t i = 0; all[i]; i++) {
        ck_assert_uint_lt(i, MAX_KERNELS);
        const bool between_ranks = all[i] == &flow_kernel_cg_pack.task;
        if (!ran[i] && (ranks > 1 || !between_ranks))
            snprintf(names + strlen(names), sizeof names - strlen(names), " %s", all[i]->name);
    }
    ck_assert_msg(!names[0], "no case has run the kernels%s", names);
}

int main(int argc, char **argv)
{
    whole = argc > 1 && !strcmp(argv[1], "long");
    quick = !whole && (argc > 1 || unit_quick());
    choices_find();
    ran = mmap(NULL, MAX_KERNELS, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return ran == MAP_FAILED ? 99 : unit_main();
}
