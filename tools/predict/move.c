/* Homes change at the beginning of a replay, by a mapping that sees the tasks of the graph, or a
 * balancer that sees the seconds of each block's tasks. They are called when and how api/migrate.c
 * calls them, with numbers of the trace in place of measurements. The time since the last call is
 * that of the host with the largest load per core. */
#include "tools/predict/program.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/map/blocks.h"

#include <math.h>
#include <stdlib.h>

struct move {
    struct predict_program *p;
    struct map_moves moves;
    struct map_policy mapping;
};

bool predict_moves_start(struct predict_program *p)
{
    const struct predict_cluster *cluster = p->graph->cluster;
    const duite_balancer *balance = cluster->balance;
    p->moves.due = 1;
    p->moves.other = base_alloc_zero(cluster->hosts * sizeof *p->moves.other);
    if (!balance || !balance->migrate)
        return p->moves.other != NULL;
    p->moves.state = base_alloc_zero(balance->state_size + 1);
    if (p->moves.state && balance->start)
        balance->start(p->moves.state, 0, (int)cluster->hosts, 0, cluster->seed);
    return p->moves.other && p->moves.state;
}

void predict_moves_stop(struct predict_program *p)
{
    free(p->moves.spent);
    base_free(p->moves.other);
    base_free(p->moves.state);
}

void predict_spend(struct predict_program *p, uint32_t object, int host, double seconds)
{
    struct predict_moves *moves = &p->moves;
    uint32_t slot = object == PREDICT_NONE ? 0 : p->name[object].slot;
    for (uint32_t h = 0; h < p->graph->cluster->hosts && host == PREDICT_ALL; h++)
        moves->other[h] += seconds / predict_speed(p->graph, h);
    if (host != PREDICT_ALL)
        seconds /= predict_speed(p->graph, (uint32_t)host);
    if (!slot && host != PREDICT_ALL)
        moves->other[host] += seconds;
    if (!slot)
        return;
    size_t before = moves->spent_capacity;
    if (!predict_grew(p->graph, BASE_GROW(moves->spent, moves->spent_capacity, (size_t)slot + 1)))
        return;
    for (size_t i = before; i < moves->spent_capacity; i++)
        moves->spent[i] = 0;
    moves->spent[slot] += seconds;
}

/* ---- Numbers for policies ---- */

static bool move_begin(struct move *m)
{
    const struct predict_cluster *cluster = m->p->graph->cluster;
    const struct predict_platform *platform = m->p->graph->platform;
    if (map_moves_new(&m->p->table, &m->moves))
        return false;
    for (size_t h = 0; h < cluster->hosts; h++)
        m->moves.workers[h] = platform->place[h].cores;
    m->moves.byte_seconds = 1 / predict_platform_bandwidth(platform);
    m->moves.message_seconds = predict_platform_latency(platform);
    m->moves.seed = cluster->seed;
    m->mapping.own = cluster->mapping;
    m->moves.mapping = &m->mapping;
    return true;
}

/* The block of an object of the main program. */
static uint32_t move_block(const struct move *m, uint32_t object)
{
    return m->moves.blocks.of[m->p->name[object].slot];
}

static void move_weigh(struct move *m)
{
    const struct predict_moves *moves = &m->p->moves;
    for (uint32_t slot = 0; slot < m->p->table.n_slots && slot < moves->spent_capacity; slot++)
        if (m->moves.blocks.of[slot] != MAP_NO_BLOCK)
            m->moves.seconds[m->moves.blocks.of[slot]] += moves->spent[slot];
    for (size_t i = 0; i < m->p->slots_capacity; i++) {
        uint32_t object = m->p->slot[i];
        if (object < m->p->graph->n_objects && move_block(m, object) != MAP_NO_BLOCK)
            m->moves.bytes[move_block(m, object)] += m->p->graph->object[object].bytes;
    }
}

/* The seconds per core of the host with the largest load per core. */
static double move_seconds(const struct move *m)
{
    const uint32_t hosts = m->p->graph->cluster->hosts;
    double max = 0;
    for (uint32_t h = 0; h < hosts; h++) {
        double sum = m->p->moves.other[h];
        for (size_t b = 0; b < m->moves.blocks.n; b++)
            sum += m->moves.blocks.block[b].home == (int)h ? m->moves.seconds[b] : 0;
        max = fmax(max, sum / m->moves.workers[h]);
    }
    return max;
}

/* As migration_show in api/migrate.c. */
static int move_show(struct move *m, const struct predict_recorded *recorded, bool *guessed)
{
    const size_t n = recorded->n_objects;
    struct plan_source source = recorded->source;
    uint32_t *block = base_alloc((n + 1) * sizeof *block);
    source.bytes = base_alloc((n + 1) * sizeof *source.bytes);
    source.n_objects = n;
    source.flag = PLAN_NONE;
    const bool fine = block && source.bytes;
    for (size_t i = 0; i < n && fine; i++) {
        source.bytes[i] = m->p->graph->object[recorded->bound[i]].bytes;
        block[i] = move_block(m, recorded->bound[i]);
    }
    const double rounds = (double)recorded->rounds;
    const int code = !fine     ? base_no_memory("the blocks of objects")
                     : guessed ? map_moves_ask(&m->moves, &source, block, guessed)
                               : map_traffic_add(&m->moves.traffic, &source, block, rounds);
    base_free(source.bytes);
    base_free(block);
    return code;
}

/* ---- Calling ---- */

static int move_call_balancer(struct move *m)
{
    const struct predict_program *p = m->p;
    struct predict_moves *moves = &m->p->moves;
    int code = DUITE_OK;
    for (size_t i = 0; i < p->n_recorded && !code; i++)
        if (p->recorded[i].bound)
            code = move_show(m, &p->recorded[i], NULL);
    if (!code)
        code = map_traffic_end(&m->moves.traffic, m->moves.blocks.n);
    if (code)
        return code;
    duite_blocks blocks = map_moves_shown(&m->moves);
    blocks.other = moves->other;
    blocks.seconds = move_seconds(m);
    blocks.replays = moves->replays;
    blocks.since = moves->replays - moves->looked;
    uint64_t next = p->graph->cluster->balance->migrate(moves->state, &blocks, m->moves.home);
    moves->due = next ? moves->replays + next : UINT64_MAX;
    return DUITE_OK;
}

static int move_call_mapping(struct move *m, struct predict_recorded *recorded)
{
    struct predict_moves *moves = &m->p->moves;
    bool guessed = false;
    const int code = move_show(m, recorded, &guessed);
    recorded->map_at = guessed && !recorded->replays ? 1 : UINT64_MAX;
    moves->due += moves->due == moves->replays;
    return code;
}

/* ---- Moving ---- */

static int move_check(const struct move *m, bool mapped)
{
    const struct predict_cluster *cluster = m->p->graph->cluster;
    for (size_t b = 0; b < m->moves.blocks.n; b++)
        if (!map_moves_is_allowed(&m->moves, b))
            return mapped ? map_moves_refused("mapping", cluster->mapping->name)
                          : map_moves_refused("balancer", cluster->balance->name);
    return DUITE_OK;
}

/* A block that moves gets a new number at its new home. */
static void move_homes(struct move *m)
{
    struct predict_program *p = m->p;
    struct predict_graph *graph = p->graph;
    map_moves_number(&m->moves, &p->table);
    for (size_t i = 0; i < p->slots_capacity && !graph->failed; i++) {
        uint32_t object = p->slot[i];
        uint32_t block = object < graph->n_objects ? move_block(m, object) : MAP_NO_BLOCK;
        if (block == MAP_NO_BLOCK || m->moves.home[block] == m->moves.blocks.block[block].home)
            continue;
        struct data_object *own = &p->table.object[p->name[object].slot];
        own->home = m->moves.home[block];
        own->block = graph->object[object].block = m->moves.blocks.block[block].number;
        predict_rehome(graph, object, own->home);
        graph->migrated++;
    }
}

/* The next call counts from here. */
static void move_forget(struct predict_program *p)
{
    for (size_t i = 0; i < p->moves.spent_capacity; i++)
        p->moves.spent[i] = 0;
    for (uint32_t h = 0; h < p->graph->cluster->hosts; h++)
        p->moves.other[h] = 0;
    for (size_t i = 0; i < p->n_recorded; i++)
        p->recorded[i].rounds = 0;
    p->moves.looked = p->moves.replays;
}

void predict_move(struct predict_program *p, struct predict_recorded *recorded)
{
    const struct predict_cluster *cluster = p->graph->cluster;
    struct predict_moves *moves = &p->moves;
    bool maps =
        cluster->mapping && cluster->mapping->map_tasks && recorded->replays == recorded->map_at;
    bool due = cluster->balance && cluster->balance->migrate && moves->replays == moves->due;
    if (cluster->hosts > 1 && (maps || due)) {
        struct move m = {.p = p};
        predict_op_wait(p);
        p->graph->failed |= !move_begin(&m);
        if (!p->graph->failed) {
            move_weigh(&m);
            p->code = maps ? move_call_mapping(&m, recorded) : move_call_balancer(&m);
        }
        if (!p->graph->failed && !p->code)
            p->code = move_check(&m, maps);
        if (!p->graph->failed && !p->code)
            move_homes(&m);
        move_forget(p);
        map_moves_free(&m.moves);
    }
    recorded->replays++;
    moves->replays++;
}
