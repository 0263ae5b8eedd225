#include "tests/runtime/rounds.h"

#include "runtime/task/owner.h"

#include <check.h>
#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const duite_law rounds_law[2];

/* ---- Making ---- */

void rounds_fork(struct rounds_made *made)
{
    ck_assert_uint_lt(made->source.n_forks, ROUNDS_MAX);
    made->fork[made->source.n_forks++] = (struct plan_source_fork){
        .first = made->source.n_accesses, .owner = PLAN_NONE, .rank = PLAN_BY_OWNER};
}

void rounds_access(struct rounds_made *made, uint32_t object, duite_mode mode, int law)
{
    ck_assert_uint_lt(made->source.n_accesses, ROUNDS_ACCESSES);
    made->fork[made->source.n_forks - 1].n++;
    made->access[made->source.n_accesses++] =
        (struct plan_access){object, mode, mode == DUITE_CW ? &rounds_law[law] : NULL};
}

void rounds_own(struct rounds_made *made)
{
    struct plan_source_fork *fork = &made->fork[made->source.n_forks - 1];
    duite_mode mode[DUITE_MAX_ACCESS] = {DUITE_NONE};
    ck_assert_uint_lt(fork->n, DUITE_MAX_ACCESS);
    for (uint32_t k = 0; k < fork->n; k++)
        mode[k] = made->access[fork->first + k].mode;
    uint32_t own = task_owner(mode, DUITE_NONE, fork->n);
    fork->owner = own == TASK_NOBODY ? PLAN_NONE : made->access[fork->first + own].object;
}

static uint32_t number_after(const char **text)
{
    char *end;
    unsigned long value = strtoul(*text, &end, 10);
    ck_assert_ptr_ne(end, *text);
    *text = end;
    return (uint32_t)value;
}

static void make_objects(struct rounds_made *made, const char *text)
{
    while (*text) {
        made->bytes[made->source.n_objects++] = number_after(&text);
        while (*text == ' ')
            text++;
    }
}

static void make_word(struct rounds_made *made, const char **text)
{
    struct plan_source_fork *fork = &made->fork[made->source.n_forks - 1];
    const char *modes = "rwucC=";
    static const duite_mode mode[] = {DUITE_R, DUITE_W, DUITE_RW, DUITE_CW, DUITE_CW, DUITE_W};
    char letter = *(*text)++;
    if (letter == 'R') {
        fork->replicated = true;
    } else if (letter == '@') {
        fork->rank = (int)number_after(text);
    } else {
        const char *at = strchr(modes, letter);
        ck_assert_ptr_nonnull(at);
        fork->sets |= letter == '=';
        rounds_access(made, number_after(text), mode[at - modes], letter == 'C');
    }
}

void rounds_make(struct rounds_made *made, const char *objects, const char *forks)
{
    *made = (struct rounds_made){.source.flag = PLAN_NONE};
    made->source.fork = made->fork;
    made->source.access = made->access;
    made->source.bytes = made->bytes;
    make_objects(made, objects);
    while (*forks) {
        rounds_fork(made);
        while (*forks && *forks != ';') {
            if (*forks == ' ')
                forks++;
            else
                make_word(made, &forks);
        }
        rounds_own(made);
        forks += *forks == ';';
        while (*forks == ' ')
            forks++;
    }
}

/* ---- Text ---- */

struct text {
    char bytes[ROUNDS_TEXT];
    size_t n;
};

__attribute__((format(printf, 2, 3))) static void put(struct text *text, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    int n = vsnprintf(text->bytes + text->n, sizeof text->bytes - text->n, format, args);
    va_end(args);
    ck_assert_int_ge(n, 0);
    text->n += (size_t)n;
    ck_assert_uint_lt(text->n, sizeof text->bytes);
}

static const char *gap(const struct text *text)
{
    return text->n ? " " : "";
}

const char *rounds_nodes(const struct plan_round *round)
{
    static const char *const name[] = {"task", "set",     "sum",  "flag",
                                       "copy", "partial", "send", "receive"};
    static struct text text;
    text = (struct text){0};
    for (size_t n = 0; n < round->n_nodes; n++) {
        const struct plan_round_node *node = &round->node[n];
        put(&text, "%s%s", gap(&text), name[node->kind]);
        if (node->kind == PLAN_SEND || node->kind == PLAN_RECEIVE)
            put(&text, " %s %d in %u", node->kind == PLAN_SEND ? "to" : "from", node->peer,
                node->phase);
        for (size_t i = 0; i < node->n_uses; i++) {
            const struct plan_node_use *use = &round->use[node->first_use + i];
            put(&text, "%s%c%u", i ? " " : "(", use->writes ? use->reads ? 'u' : 'w' : 'r',
                use->place);
        }
        for (size_t i = 0; i < node->n_merges; i++) {
            const struct plan_merge *merge = &round->merge[node->first_merge + i];
            put(&text, "%s%u+%u", i ? " " : " | ", merge->left, merge->right);
        }
        put(&text, node->n_uses ? ")" : "()");
    }
    return text.bytes;
}

const char *rounds_edges(const struct plan_round *round)
{
    static struct text text;
    text = (struct text){0};
    for (size_t i = 0; i < round->n_edges; i++)
        put(&text, "%s%u%s%u", gap(&text), round->edge[i].from, round->edge[i].cyclic ? "~>" : ">",
            round->edge[i].to);
    return text.bytes;
}

static void put_set(struct text *text, const struct plan_assignment *a, const uint64_t *set)
{
    bool any = false;
    for (int rank = 0; rank < a->n_ranks; rank++) {
        if (!base_ranks_has(set, rank))
            continue;
        put(text, "%d", rank);
        any = true;
    }
    if (!any)
        put(text, "-");
}

const char *rounds_ranks(const struct plan_assignment *a)
{
    static struct text text;
    text = (struct text){0};
    for (size_t n = 0; n < a->round->n_nodes; n++) {
        put(&text, "%s", gap(&text));
        put_set(&text, a, plan_runs_set(a, n));
    }
    return text.bytes;
}

const char *rounds_needs(const struct plan_assignment *a)
{
    static struct text text;
    text = (struct text){0};
    for (size_t v = 0; v < a->n_versions; v++) {
        bool any = false;
        for (int rank = 0; rank < a->n_ranks; rank++)
            any |= base_ranks_has(plan_needs_set(a, v), rank);
        if (!any)
            continue;
        put(&text, "%s%zu:", gap(&text), v);
        put_set(&text, a, plan_needs_set(a, v));
    }
    return text.bytes;
}

const char *rounds_messages(const struct plan_messages *m)
{
    static struct text text;
    text = (struct text){0};
    for (size_t i = 0; i < m->n_messages; i++) {
        const struct plan_message *message = &m->message[i];
        put(&text, "%s%d>%d in %u:", i ? "; " : "", message->from, message->to, message->phase);
        for (size_t k = message->first; k; k = m->item[k - 1].next) {
            const struct plan_item *item = &m->item[k - 1];
            bool version = item->version != PLAN_NONE;
            if (version || item->piece != PLAN_NONE)
                put(&text, " %c%u", version ? 'v' : 'p', version ? item->version : item->piece);
            else
                put(&text, " %u+%u", (unsigned)item->tree.first, 1u << item->tree.level);
        }
    }
    return text.bytes;
}

const char *rounds_phases(const struct plan_messages *m)
{
    static struct text text;
    text = (struct text){0};
    for (size_t n = 0; n < m->assignment->round->n_nodes; n++)
        put(&text, "%s%u", gap(&text), m->phase[n]);
    return text.bytes;
}
