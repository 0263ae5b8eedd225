/* Runs that are asked to stop inside a step, and go on from their last checkpoint. Bodies that poll
 * for a stop differ from run to run, so none is in checking mode. */
#include "tests/cloth/flow/checked_runs.h"

/* A stop gives a step up that would be solved again, and a run that goes on from there ends with
 * the same bits. So that it falls into any solve and cut of the first two steps, polls are counted.
 */
static void stop_at_polls(const char *integrator, unsigned *in_first)
{
    static const char *const mode = "contact={mode: certified, self: on, thickness: 0.0005}";
    static const char *const above =
        "cloths[1]={mesh: {grid: {width: 1, height: 1, nx: 3, ny: 3}}, material: triangles, "
        "velocity: [0, -30, 0], transform: {translate: [0.1, 0.001, 0.1]}}";
    const char *const sets[MAX_SETS] = {
        mode, above, integrator, "time.end=0.003", "solver.stop={count: 1}", "probes=[]"};
    struct how undisturbed = {.unchecked = true};
    run_how(&undisturbed, sets);
    for (unsigned polls = 1; polls < 100; polls += 18) {
        struct how first = {.unchecked = true, .saves = true, .stops = polls};
        struct how next = {.unchecked = true};
        run_how(&first, sets);
        *in_first += first.report.stopped && !first.report.steps;
        next.from = first.saved;
        run_how(&next, sets);
        ck_assert_msg(next.report.state_hash == undisturbed.report.state_hash,
                      "%s: stopped at poll %u, step %llu", integrator, polls,
                      (unsigned long long)first.report.steps);
        free(first.saved.bytes);
    }
}

UNIT_TEST(stop_inside_a_step)
{
    unsigned in_first = 0;
    stop_at_polls("integrator=implicit_euler", &in_first);
    stop_at_polls("integrator=bdf2", &in_first);
    ck_assert_uint_gt(in_first, 0);
}
