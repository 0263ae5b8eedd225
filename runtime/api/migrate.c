/* Homes change at the beginning of a replay that is due, when all ranks have come to it and no task
 * is left. Each rank reports the seconds in bodies of its blocks. Rank 0 asks the mapping, or the
 * balancer, and broadcasts the moves. All ranks move the same blocks in the same order. The rank of
 * each task, the ranks that need a value and the plans of recorded graphs are then derived
 * again. */
#include "runtime/api/instance.h"

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/map/blocks.h"

/* Places in `values`: a rank's report, about itself and then its blocks; rank 0's answer, for all
 * and then the blocks that move. */
enum { REPORT_WORKERS, REPORT_OTHER, REPORT_BLOCKS };
enum { ANSWER_CODE, ANSWER_REFUSED, ANSWER_NEXT, ANSWER_AGAIN, ANSWER_MOVES, ANSWER_BLOCKS };

#define NEVER (UINT64_C(1) << 52) /* replays; a double has room for them */

struct migration {
    duite *rt;
    const struct plan_record
        *record;            /* the mapping is to see its tasks; NULL: the balancer's turn */
    struct map_moves moves; /* measured values: on rank 0 */
    size_t *first;          /* n_ranks + 1: of each rank's blocks in `row` */
    uint32_t *row;          /* blocks by home */
    double *values;         /* this rank's report, then rank 0's answer */
    size_t longest;         /* the most values of a rank */
    double *other;          /* n_ranks; rank 0 */
};

static void migration_free(struct migration *m)
{
    map_moves_free(&m->moves);
    base_free(m->first);
    base_free(m->row);
    base_free(m->values);
    base_free(m->other);
}

/* Blocks by home, in their order. */
static void migration_sort(struct migration *m)
{
    size_t n = m->moves.blocks.n, ranks = (size_t)m->rt->graph.n_ranks;
    for (size_t i = 0; i < n; i++)
        m->first[m->moves.blocks.block[i].home + 1]++;
    for (size_t r = 0; r < ranks; r++)
        m->first[r + 1] += m->first[r];
    for (size_t i = 0; i < n; i++)
        m->row[m->first[m->moves.blocks.block[i].home]++] = (uint32_t)i;
    for (size_t r = ranks; r-- > 0;)
        m->first[r + 1] = m->first[r];
    m->first[0] = 0;
}

static int migration_begin(struct migration *m)
{
    size_t ranks = (size_t)m->rt->graph.n_ranks;
    int code = map_moves_new(&m->rt->graph.table, &m->moves);
    if (code)
        return code;
    size_t n = m->moves.blocks.n, said = (n + REPORT_BLOCKS + ANSWER_BLOCKS) * sizeof *m->values;
    m->first = base_alloc_zero((ranks + 1) * sizeof *m->first);
    m->row = base_alloc(n * sizeof *m->row + 1);
    m->values = base_alloc(said);
    m->other = base_alloc(ranks * sizeof *m->other);
    if (!m->first || !m->row || !m->values || !m->other)
        return base_no_memory("blocks that move");
    migration_sort(m);
    return DUITE_OK;
}

/* ---- Measurements go to rank 0 ---- */

/* Seconds s of a fixed block are reported as -1 - s. */
static void migration_fill_own(struct migration *m)
{
    struct work_pool *pool = m->rt->pool;
    const size_t *first = m->first + m->rt->graph.rank;
    m->values[REPORT_WORKERS] = m->rt->share.workers;
    m->values[REPORT_OTHER] = work_block_seconds(pool, DUITE_NO_BLOCK);
    for (size_t i = first[0]; i < first[1]; i++) {
        const struct map_block *block = &m->moves.blocks.block[m->row[i]];
        double seconds = work_block_seconds(pool, block->number);
        m->values[REPORT_BLOCKS + i - first[0]] = block->fixed ? -1 - seconds : seconds;
    }
}

static size_t migration_length(const struct migration *m, int rank)
{
    return REPORT_BLOCKS + m->first[rank + 1] - m->first[rank];
}

/* Each rank gives `own` of its values to all, a word at a time; `take` gets those below longest. */
static int migration_share(struct migration *m, size_t own,
                           void (*take)(struct migration *m, int rank, size_t i, double value))
{
    static const struct work_why why = {"duite_replay", "the other ranks to move blocks", NULL};
    const struct comm_word *words = comm_words(m->rt->comm);
    int code = DUITE_OK;
    for (size_t at = 0; at < m->longest && !code; at += COMM_WORD_NUMBERS) {
        struct comm_word word = {0};
        for (size_t i = 0; i < COMM_WORD_NUMBERS && at + i < own; i++)
            word.number[i] = m->values[at + i];
        code = api_collective(m->rt, &why, COMM_GATHERS, &word);
        for (int r = 0; r < m->rt->graph.n_ranks && !code; r++)
            for (size_t i = 0; i < COMM_WORD_NUMBERS && at + i < m->longest; i++)
                take(m, r, at + i, words[r].number[i]);
    }
    return code;
}

static void migration_take_report(struct migration *m, int rank, size_t i, double value)
{
    if (m->rt->graph.rank || i >= migration_length(m, rank))
        return;
    if (i == REPORT_WORKERS)
        m->moves.workers[rank] = (unsigned)value;
    if (i == REPORT_OTHER)
        m->other[rank] = value;
    if (i < REPORT_BLOCKS)
        return;
    uint32_t block = m->row[m->first[rank] + i - REPORT_BLOCKS];
    m->moves.fixed[block] = value < 0;
    m->moves.seconds[block] = value < 0 ? -1 - value : value;
}

static int migration_report(struct migration *m)
{
    for (int r = 0; r < m->rt->graph.n_ranks; r++)
        m->longest = migration_length(m, r) > m->longest ? migration_length(m, r) : m->longest;
    migration_fill_own(m);
    return migration_share(m, migration_length(m, m->rt->graph.rank), migration_take_report);
}

/* ---- Rank 0 decides ---- */

static double migration_byte_seconds(const duite *rt)
{
    return 1e-6 * (comm_transfer(rt->comm, 1000000) - comm_transfer(rt->comm, 0));
}

/* Shows a record to the mapping, which writes the homes to be; or (guessed NULL) adds the traffic
 * of so many of its rounds. *guessed: the mapping is to see it once more when all costs are
 * measured.
 */
static int migration_show(struct migration *m, const struct plan_record *record, double rounds,
                          bool *guessed)
{
    struct plan_source source;
    uint32_t *block = base_alloc((record->n_objects + 1) * sizeof *block);
    const bool fine = plan_record_source(record, NULL, &source) && block;
    for (size_t i = 0; i < record->n_objects && fine; i++)
        block[i] = m->moves.blocks.of[record->object[i].bound.slot];
    const int code = !fine     ? base_no_memory("the blocks of objects")
                     : guessed ? map_moves_ask(&m->moves, &source, block, guessed)
                               : map_traffic_add(&m->moves.traffic, &source, block, rounds);
    plan_source_free(&source);
    base_free(block);
    return code;
}

static int migration_add_traffic(void *context, const struct plan_record *record, double rounds)
{
    return migration_show(context, record, rounds, NULL);
}

static int migration_ask_balancer(struct migration *m, uint64_t *next)
{
    const struct instance_migration *last = &m->rt->migration;
    int code = api_graphs_each(m->rt, migration_add_traffic, m);
    if (!code)
        code = map_traffic_end(&m->moves.traffic, m->moves.blocks.n);
    if (code)
        return code;
    duite_blocks blocks = map_moves_shown(&m->moves);
    blocks.other = m->other;
    blocks.seconds = base_seconds() - last->since;
    blocks.migrate_seconds = last->took;
    blocks.replays = last->replays;
    blocks.since = last->replays - last->looked;
    *next = work_migrate(m->rt->pool, &blocks, m->moves.home);
    return DUITE_OK;
}

static int migration_decide(struct migration *m)
{
    size_t n_moves = 0;
    uint64_t next = 0;
    bool again = false;
    m->moves.byte_seconds = migration_byte_seconds(m->rt);
    m->moves.message_seconds = comm_transfer(m->rt->comm, 0);
    m->moves.seed = m->rt->seed;
    m->moves.mapping = &m->rt->mapping;
    for (size_t i = 0; i < m->moves.blocks.n; i++)
        m->moves.bytes[i] = m->moves.blocks.block[i].bytes;
    int code =
        m->record ? migration_show(m, m->record, 0, &again) : migration_ask_balancer(m, &next);
    if (code && (code == DUITE_E_MEMORY || !m->record))
        return code;
    m->values[ANSWER_NEXT] = next < NEVER ? (double)next : 0;
    m->values[ANSWER_AGAIN] = again;
    m->values[ANSWER_CODE] = code;
    m->values[ANSWER_REFUSED] = 0;
    for (size_t i = 0; i < m->moves.blocks.n && !code; i++) {
        if (!map_moves_is_allowed(&m->moves, i))
            m->values[ANSWER_REFUSED] = 1;
        else if (m->moves.home[i] != m->moves.blocks.block[i].home)
            m->values[ANSWER_BLOCKS + n_moves++] =
                (double)i * m->rt->graph.n_ranks + m->moves.home[i];
    }
    m->values[ANSWER_MOVES] = (double)n_moves;
    return DUITE_OK;
}

/* ---- All move ---- */

static void migration_take_answer(struct migration *m, int rank, size_t i, double value)
{
    if (rank)
        return;
    m->values[i] = value;
    if (i == ANSWER_MOVES)
        m->longest = ANSWER_BLOCKS + (size_t)value;
}

static int migration_announce(struct migration *m)
{
    m->longest = ANSWER_BLOCKS; /* at least */
    const size_t own = m->rt->graph.rank ? 0 : ANSWER_BLOCKS + (size_t)m->values[ANSWER_MOVES];
    return migration_share(m, own, migration_take_answer);
}

/* All ranks got the same answer, so they move the same blocks in the same order. */
static int migration_move(struct migration *m)
{
    struct task_graph *graph = &m->rt->graph;
    struct data_table *table = &graph->table;
    size_t n_moves = (size_t)m->values[ANSWER_MOVES];
    int code = DUITE_OK;
    for (size_t i = 0; i < m->moves.blocks.n; i++)
        m->moves.home[i] = m->moves.blocks.block[i].home;
    for (size_t i = 0; i < n_moves; i++) {
        const uint64_t answer = (uint64_t)m->values[ANSWER_BLOCKS + i];
        const size_t block = (size_t)(answer / (uint64_t)graph->n_ranks);
        m->moves.home[block] = (int)(answer % (uint64_t)graph->n_ranks);
    }
    map_moves_number(&m->moves, table);
    for (uint32_t slot = 0; slot < table->n_slots && n_moves && !code; slot++) {
        uint32_t block = m->moves.blocks.of[slot];
        struct data_object *object = &table->object[slot];
        if (block == MAP_NO_BLOCK || m->moves.home[block] == object->home)
            continue;
        object->block = m->moves.blocks.block[block].number;
        code = task_move_object(graph, m->rt->worker, object, m->moves.home[block]);
        trace_moved(m->rt->trace, table, &slot, 1);
        m->rt->migration.objects++;
    }
    work_tick(m->rt->pool);
    return code;
}

/* Notes when to ask the mapping, or the balancer, again. */
static void migration_schedule(const struct migration *m, uint64_t replay, uint64_t *map_at)
{
    struct instance_migration *last = &m->rt->migration;
    uint64_t next = (uint64_t)m->values[ANSWER_NEXT];
    if (m->record)
        *map_at = m->values[ANSWER_AGAIN] > 0 && !replay ? 1 : UINT64_MAX;
    if (m->record && last->due == last->replays)
        last->due++;
    if (!m->record)
        last->due = next ? last->replays + next : UINT64_MAX;
    last->looked = last->replays;
}

/* The error of a policy that failed or gave a wrong answer: the same on all ranks. */
static int migration_refused(const struct migration *m)
{
    int code = (int)m->values[ANSWER_CODE];
    if (code)
        return base_error(code, "mapping %s failed on rank 0 with code %d (%s)",
                          m->rt->mapping.own->name, code, duite_code_text(code));
    if (!(m->values[ANSWER_REFUSED] > 0))
        return DUITE_OK;
    return m->record ? map_moves_refused("mapping", m->rt->mapping.own->name)
                     : map_moves_refused("balancer", m->rt->balance->name);
}

static int migration_run(struct migration *m, uint64_t replay, uint64_t *map_at)
{
    duite *rt = m->rt;
    int code = api_meet(rt, "duite_replay", NULL);
    if (!code)
        code = migration_begin(m);
    if (!code)
        code = migration_report(m);
    const double begun =
        base_seconds(); /* measured from here: before, this rank also waited for tasks */
    const uint64_t ticks = base_ticks(), moved = rt->migration.objects;
    if (!code && !rt->graph.rank)
        code = migration_decide(m);
    if (!code)
        code = migration_announce(m);
    if (code)
        return code;
    struct instance_migration *last = &rt->migration;
    migration_schedule(m, replay, map_at);
    code = migration_refused(m);
    if (code)
        return code;
    code = migration_move(m);
    trace_put(rt->worker->ring, &(struct trace_event){.begin = ticks,
                                                      .took = base_ticks() - ticks,
                                                      .number = last->objects - moved,
                                                      .kind = TRACE_MIGRATE});
    last->since = base_seconds();
    last->took = last->since - begun;
    return code;
}

int api_migrate(duite *rt, const struct plan_record *record, uint64_t replay, uint64_t *map_at)
{
    struct instance_migration *own = &rt->migration;
    bool maps = rt->mapping.own->map_tasks && replay == *map_at;
    int code = DUITE_OK;
    if (rt->comm && (maps || (rt->balance->migrate && own->replays == own->due))) {
        struct migration m = {.rt = rt, .record = maps ? record : NULL};
        code = migration_run(&m, replay, map_at);
        migration_free(&m);
    }
    if (!own->replays++)
        own->since = base_seconds();
    return code;
}
