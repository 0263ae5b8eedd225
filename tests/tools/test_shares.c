/* The columns of a chart, of a trace written by hand: one worker, a tick a second. */
#include "runtime/base/memory.h"
#include "tests/support/unit.h"
#include "tools/chart/model.h"

#include <math.h>
#include <stdio.h>

enum { OUTER, INNER, KERNELS, COLUMNS = 5, SLOTS = KERNELS + CHART_STATES };

/* INNER 2 .. 4 and idle 5 .. 6 (half of it with messages awaited) within OUTER 1 .. 8; then INNER
 * 8 .. 10. In the order of their ends. */
static const struct trace_event EVENTS[] = {
    {.begin = 2, .took = 2, .number = 2, .kernel = INNER, .kind = TRACE_TASK},
    {.begin = 5, .took = 2, .within = 1, .kind = TRACE_IDLE},
    {.begin = 1, .took = 7, .within = 4, .number = 1, .kernel = OUTER, .kind = TRACE_TASK},
    {.begin = 8, .took = 2, .number = 3, .kernel = INNER, .kind = TRACE_TASK}};

static struct chart_shares shares_of(double from, double to)
{
    static const struct trace_header header = {.n_ranks = 1, .workers = 1, .tick = 1};
    static struct trace_piece piece = {.event = EVENTS, .n = sizeof EVENTS / sizeof *EVENTS};
    static struct trace_rank rank = {.header = &header, .piece = &piece, .n_pieces = 1};
    const struct trace_run run = {.n_ranks = 1, .n_kernels = KERNELS, .rank = &rank};
    uint32_t row = 0, slot[SLOTS];
    struct chart_shares shares;
    for (uint32_t s = 0; s < SLOTS; s++)
        slot[s] = s;
    ck_assert_int_eq(chart_shares_make(&shares, from, to, 1, COLUMNS, SLOTS), DUITE_OK);
    ck_assert_int_eq(chart_shares_fill(&shares, &run, &row, slot), DUITE_OK);
    return shares;
}

static void column_is(const struct chart_shares *shares, uint32_t column, double outer,
                      double inner, double idle, double awaiting)
{
    const double *seconds = chart_shares_of(shares, 0, column);
    const double wanted[SLOTS] = {[OUTER] = outer,
                                  [INNER] = inner,
                                  [KERNELS + CHART_IDLE] = idle,
                                  [KERNELS + CHART_AWAITING] = awaiting};
    for (uint32_t s = 0; s < SLOTS; s++)
        ck_assert_msg(fabs(seconds[s] - wanted[s]) < 1e-12, "column %u slot %u: %g, not %g", column,
                      s, seconds[s], wanted[s]);
}

/* Columns 0 .. 2 .. 4 .. 6 .. 8 .. 10. */
UNIT_TEST(columns_have_their_shares)
{
    struct chart_shares shares = shares_of(0, 10);
    column_is(&shares, 0, 1, 0, 0, 0);
    column_is(&shares, 1, 0, 2, 0, 0);
    column_is(&shares, 2, 1, 0, 0.5, 0.5);
    column_is(&shares, 3, 1, 0, 0.5, 0.5);
    column_is(&shares, 4, 0, 2, 0, 0);
    base_free(shares.seconds);
}

/* Busy from 3.5 to 8.5: less 1 .. idle 5 .. 7. */
UNIT_TEST(windows_cut)
{
    struct chart_shares shares = shares_of(3.5, 8.5);
    double outer = 0, inner = 0;
    for (uint32_t c = 0; c < COLUMNS; c++) {
        outer += chart_shares_of(&shares, 0, c)[OUTER];
        inner += chart_shares_of(&shares, 0, c)[INNER];
    }
    ck_assert(fabs(outer - 2) < 1e-12 && fabs(inner - 1) < 1e-12);
    base_free(shares.seconds);
}
