#ifndef CLOTH_FLOW_STATE_KERNEL_H
#define CLOTH_FLOW_STATE_KERNEL_H

#include "cloth/flow/state/fields.h"

/* How a kernel is declared, and forked. A kernel names the fields (fields.h) that its task uses,
 * once, in front of its body:
 *
 *     FLOW_KERNEL(velocity, FLOW_VELOCITY, struct flow_step_args,
 *                 (R(table), R(dv), RW(v), W(halo_v), SUM(status)))
 *     {
 *         const struct flow_table table = flow_table_in(call, on->table), *t = &table;
 *         phys_advance(t->n, 1, on->dv, on->v);
 *         ...
 *     }
 *
 * The rest follows: the head of the body, `static int velocity_body(const duite_call *call, const
 * struct velocity_fields *on)`, its struct of pointers, the parameters' modes, and the objects at
 * the fork, `flow_fork_each(state, &flow_kernel_velocity, &args)`. A pointer has the type that the
 * field's row says, const under R. A field that is undeclared or misspelt does not compile, nor
 * does a kernel that is missing in the list of kernels.h. A kernel's name in traces is its name
 * here. With a semicolon behind it the body comes further down, with its head, below what it calls.
 *
 *     R W RW     reads, overwrites, changes: a field of the task's block or of the run
 *     SUM MAX    contributes to it, added up, or the largest counts
 *     W_IF RW_IF overwrites, changes it if it exists in the run; else the pointer is NULL
 *     SUM_ELSE   contributes to it in a run that lacks those
 *     NEIGHBOURS reads this field of each neighbour, ascending by block
 *     ALL        reads this field of every block that has it; the last parameter of a kernel
 *     IF_MADE    reads it if it exists in the run, in all blocks or in none; else the pointer is
 *                NULL
 *     TIED       reads this field of each block that ties (ties.h) join this one with, ascending,
 *                if it exists in the run; a member tied_field. IF_MADE(tie_table) comes before it
 *     KEEPERS    reads this field of each block that may keep contacts with corners in this one,
 *                ascending; the last parameter, and a member n_field says how many
 *     GIVEN_R GIVEN_W GIVEN_RW GIVEN_SUM  an object of FLOW_OBJECTS, which the fork gives
 *     REST_R REST_W                reads, or overwrites, all further ones that the fork gives; the
 *                                  last parameter, and a member n_object says how many
 *
 * W_IF, RW_IF and SUM_ELSE, then NEIGHBOURS, IF_MADE and TIED come behind the others, in this
 * order; ALL comes last. A body gets NEIGHBOURS, ALL, TIED, KEEPERS and REST as parameters:
 * flow_rows_of, flow_numbers_of.
 *
 * FLOW_INDEX_OF(velocity, v) is the index of a parameter, for calls of the runtime that want one.
 *
 * The arguments are a struct whose first member is `uint32_t block`: that alone (struct
 * flow_block_args), those of a step (struct flow_step_args), or a kernel's own. `on->args` are
 * those of the task. Bodies pass shared functions the arguments that these need; a shared function
 * takes only the block from `call` (flow_block_of). So a kernel that lacks an argument does not
 * compile.
 *
 * The task's seconds count for a part of the step (enum flow_part); FLOW_NO_PART: for none. */
#define FLOW_KERNEL(name, part, arguments, fields)                                                 \
    FLOW_KERNEL_WITH(name, part, arguments, fields, .side_effects = 0)

/* The same with more members of duite_kernel, such as .replicated = 1 or .side_effects = 1. */
#define FLOW_KERNEL_WITH(name, part, arguments, fields, ...)                                       \
    FLOW_KERNEL_OPEN(name, part, arguments, fields)                                                \
    const struct flow_kernel flow_kernel_##name = {                                                \
        .task = FLOW_TASK(name, #name, WITH, arguments, fields, __VA_ARGS__),                      \
        .parameter = {FLOW_EACH(FLOW_PARAMETER, name, fields)}};                                   \
    FLOW_KERNEL_BODY(name)

/* A kernel with W_IF, RW_IF, SUM_ELSE, which exist together with this field. The runtime knows two,
 * name and name_less: it is in the list FLOW_KERNELS_IF, too. */
#define FLOW_KERNEL_IF(name, field, part, arguments, fields, ...)                                  \
    FLOW_KERNEL_OPEN(name, part, arguments, fields)                                                \
    const duite_kernel flow_kernel_##name##_less =                                                 \
        FLOW_TASK(name, #name "_less", LESS, arguments, fields, __VA_ARGS__);                      \
    const struct flow_kernel flow_kernel_##name = {                                                \
        .task = FLOW_TASK(name, #name, WITH, arguments, fields, __VA_ARGS__),                      \
        .less = &flow_kernel_##name##_less,                                                        \
        .with = FLOW_FIELD_##field,                                                                \
        .parameter = {FLOW_EACH(FLOW_PARAMETER, name, fields)}};                                   \
    FLOW_KERNEL_BODY(name)

#define FLOW_INDEX_OF(name, field) name##_at_##field

/* ---- For the macros above ---- */

/* The owner of a parameter's object. */
enum flow_whose {
    FLOW_NOBODY,
    FLOW_OWN,
    FLOW_OWN_IF_MADE,
    FLOW_OF_NEIGHBOURS,
    FLOW_IF_MADE,
    FLOW_OF_TIED,
    FLOW_OF_ALL,
    FLOW_OF_KEEPERS,
    FLOW_OF_FORK,
    FLOW_REST_OF_FORK
};

struct flow_parameter {
    enum flow_whose whose;
    enum flow_field_id field;
};

enum { FLOW_MAX_PARAMETERS = 24 }; /* as many as FLOW_EACH takes */

struct flow_kernel {
    duite_kernel task;
    const duite_kernel *less; /* the task in runs without the field `with`; NULL: the same */
    enum flow_field_id with;
    struct flow_parameter parameter[FLOW_MAX_PARAMETERS + 1]; /* ended by FLOW_NOBODY */
};

/* FLOW_EACH(f, k, (a, b)) is f(k, a) f(k, b); at most FLOW_MAX_PARAMETERS. */
#define FLOW_EACH(f, k, list) FLOW_EACH_OF(f, k, FLOW_LISTED list)
#define FLOW_LISTED(...)      __VA_ARGS__
#define FLOW_EACH_OF(...)     FLOW_EACH_IN(__VA_ARGS__)
#define FLOW_EACH_IN(f, k, ...)                                                                    \
    FLOW_NTH(__VA_ARGS__, FLOW_E24, FLOW_E23, FLOW_E22, FLOW_E21, FLOW_E20, FLOW_E19, FLOW_E18,    \
             FLOW_E17, FLOW_E16, FLOW_E15, FLOW_E14, FLOW_E13, FLOW_E12, FLOW_E11, FLOW_E10,       \
             FLOW_E9, FLOW_E8, FLOW_E7, FLOW_E6, FLOW_E5, FLOW_E4, FLOW_E3, FLOW_E2, FLOW_E1, 0)   \
    (f, k, __VA_ARGS__)
#define FLOW_NTH(a, b, c, d, e, g, h, i, j, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z, it, ...) it
#define FLOW_E1(f, k, a)                                                                          f(k, a)
#define FLOW_E2(f, k, a, ...)                                                                     f(k, a) FLOW_E1(f, k, __VA_ARGS__)
#define FLOW_E3(f, k, a, ...)                                                                     f(k, a) FLOW_E2(f, k, __VA_ARGS__)
#define FLOW_E4(f, k, a, ...)                                                                     f(k, a) FLOW_E3(f, k, __VA_ARGS__)
#define FLOW_E5(f, k, a, ...)                                                                     f(k, a) FLOW_E4(f, k, __VA_ARGS__)
#define FLOW_E6(f, k, a, ...)                                                                     f(k, a) FLOW_E5(f, k, __VA_ARGS__)
#define FLOW_E7(f, k, a, ...)                                                                     f(k, a) FLOW_E6(f, k, __VA_ARGS__)
#define FLOW_E8(f, k, a, ...)                                                                     f(k, a) FLOW_E7(f, k, __VA_ARGS__)
#define FLOW_E9(f, k, a, ...)                                                                     f(k, a) FLOW_E8(f, k, __VA_ARGS__)
#define FLOW_E10(f, k, a, ...)                                                                    f(k, a) FLOW_E9(f, k, __VA_ARGS__)
#define FLOW_E11(f, k, a, ...)                                                                    f(k, a) FLOW_E10(f, k, __VA_ARGS__)
#define FLOW_E12(f, k, a, ...)                                                                    f(k, a) FLOW_E11(f, k, __VA_ARGS__)
#define FLOW_E13(f, k, a, ...)                                                                    f(k, a) FLOW_E12(f, k, __VA_ARGS__)
#define FLOW_E14(f, k, a, ...)                                                                    f(k, a) FLOW_E13(f, k, __VA_ARGS__)
#define FLOW_E15(f, k, a, ...)                                                                    f(k, a) FLOW_E14(f, k, __VA_ARGS__)
#define FLOW_E16(f, k, a, ...)                                                                    f(k, a) FLOW_E15(f, k, __VA_ARGS__)
#define FLOW_E17(f, k, a, ...)                                                                    f(k, a) FLOW_E16(f, k, __VA_ARGS__)
#define FLOW_E18(f, k, a, ...)                                                                    f(k, a) FLOW_E17(f, k, __VA_ARGS__)
#define FLOW_E19(f, k, a, ...)                                                                    f(k, a) FLOW_E18(f, k, __VA_ARGS__)
#define FLOW_E20(f, k, a, ...)                                                                    f(k, a) FLOW_E19(f, k, __VA_ARGS__)
#define FLOW_E21(f, k, a, ...)                                                                    f(k, a) FLOW_E20(f, k, __VA_ARGS__)
#define FLOW_E22(f, k, a, ...)                                                                    f(k, a) FLOW_E21(f, k, __VA_ARGS__)
#define FLOW_E23(f, k, a, ...)                                                                    f(k, a) FLOW_E22(f, k, __VA_ARGS__)
#define FLOW_E24(f, k, a, ...)                                                                    f(k, a) FLOW_E23(f, k, __VA_ARGS__)

/* clang-format off */
/* A word: its kind; whether the runtime's kernel lists it by itself, in the form WITH and in LESS (the
 * others are further ones); `const` if it only reads, mode and law there; whose object, the field. */
#define FLOW_WORD_R(field)          FIXED, 1, 1, const, DUITE_R, NULL, FLOW_OWN, field
#define FLOW_WORD_W(field)          FIXED, 1, 1, , DUITE_W, NULL, FLOW_OWN, field
#define FLOW_WORD_RW(field)         FIXED, 1, 1, , DUITE_RW, NULL, FLOW_OWN, field
#define FLOW_WORD_SUM(field)        FIXED, 1, 1, , DUITE_CW, &duite_sum, FLOW_OWN, field
#define FLOW_WORD_MAX(field)        FIXED, 1, 1, , DUITE_CW, &duite_max, FLOW_OWN, field
#define FLOW_WORD_W_IF(field)       MADE, 1, 0, , DUITE_W, NULL, FLOW_OWN_IF_MADE, field
#define FLOW_WORD_RW_IF(field)      MADE, 1, 0, , DUITE_RW, NULL, FLOW_OWN_IF_MADE, field
#define FLOW_WORD_SUM_ELSE(field)   MADE, 0, 1, , DUITE_CW, &duite_sum, FLOW_OWN_IF_MADE, field
#define FLOW_WORD_IF_MADE(field)    MADE, 0, 0, const, DUITE_R, , FLOW_IF_MADE, field
#define FLOW_WORD_NEIGHBOURS(field) MANY, 0, 0, const, DUITE_R, , FLOW_OF_NEIGHBOURS, field
#define FLOW_WORD_ALL(field)        MANY, 0, 0, const, DUITE_R, , FLOW_OF_ALL, field
#define FLOW_WORD_TIED(field)       TIED, 0, 0, const, DUITE_R, , FLOW_OF_TIED, field
#define FLOW_WORD_KEEPERS(field)    REST, 0, 0, const, DUITE_R, , FLOW_OF_KEEPERS, field
#define FLOW_WORD_GIVEN_R(object)   FIXED, 1, 1, const, DUITE_R, NULL, FLOW_OF_FORK, object
#define FLOW_WORD_GIVEN_W(object)   FIXED, 1, 1, , DUITE_W, NULL, FLOW_OF_FORK, object
#define FLOW_WORD_GIVEN_RW(object)  FIXED, 1, 1, , DUITE_RW, NULL, FLOW_OF_FORK, object
#define FLOW_WORD_GIVEN_SUM(object) FIXED, 1, 1, , DUITE_CW, &duite_sum, FLOW_OF_FORK, object
#define FLOW_WORD_REST_R(object)    REST, 0, 0, const, DUITE_R, , FLOW_REST_OF_FORK, object
#define FLOW_WORD_REST_W(object)    REST, 0, 0, const, DUITE_W, , FLOW_REST_OF_FORK, object
#define FLOW_SPREAD(f, ...)         f(__VA_ARGS__)
#define FLOW_IF_1(...)              __VA_ARGS__
#define FLOW_IF_0(...)

/* name_at_field, of parameters that are always there. */
#define FLOW_INDEX(k, word) FLOW_SPREAD(FLOW_INDEX_IN, k, FLOW_WORD_##word)
#define FLOW_INDEX_IN(k, kind, with, less, only, mode, law, whose, field)                          \
    FLOW_IF_##with(FLOW_IF_##less(FLOW_INDEX_OF(k, field),))

/* Members of struct name_fields. */
#define FLOW_HAS(k, word) FLOW_SPREAD(FLOW_HAS_IN, k, FLOW_WORD_##word)
#define FLOW_HAS_IN(k, kind, with, less, only, mode, law, whose, field) FLOW_HAS_##kind(only, field)
#define FLOW_HAS_FIXED(only, field) only flow_type_of_##field *field;
#define FLOW_HAS_MADE(only, field)  only flow_type_of_##field *field;
#define FLOW_HAS_MANY(only, field)  only duite_param *field;
#define FLOW_HAS_TIED(only, field)  only duite_param *tied_##field;
#define FLOW_HAS_REST(only, field)  only duite_param *field; size_t n_##field;

/* Fills them. */
#define FLOW_OPEN(k, word) FLOW_SPREAD(FLOW_OPEN_IN, k, FLOW_WORD_##word)
#define FLOW_OPEN_IN(k, kind, with, less, only, mode, law, whose, field)                           \
    FLOW_OPEN_##kind(k, whose, field)
#define FLOW_OPEN_FIXED(k, whose, field) on.field = call->param[FLOW_INDEX_OF(k, field)].data;
#define FLOW_OPEN_MADE(k, whose, field)                                                            \
    on.field = flow_of(call)->made[FLOW_FIELD_##field] ? call->param[next++].data : NULL;
#define FLOW_OPEN_MANY(k, whose, field)                                                            \
    on.field = call->param + next;                                                                 \
    next += whose == FLOW_OF_ALL ? flow_of(call)->tables.n_blocks : flow_shape_of(call)->n_neighbours;
#define FLOW_OPEN_TIED(k, whose, field)                                                            \
    on.tied_##field = call->param + next;                                                          \
    next += flow_of(call)->made[FLOW_FIELD_##field] ? flow_ties_others(on.tie_table) : 0;
#define FLOW_OPEN_REST(k, whose, field)                                                            \
    on.field = call->param + next;                                                                 \
    on.n_##field = call->n_params - next;

/* Members of the runtime's kernel, of the form WITH or LESS what a run may lack. */
#define FLOW_MODE(form, word) FLOW_SPREAD(FLOW_MODE_IN, form, FLOW_WORD_##word)
#define FLOW_MODE_IN(form, kind, with, less, only, mode, law, whose, field)                        \
    FLOW_IN_##form(with, less, mode)
#define FLOW_LAW(form, word) FLOW_SPREAD(FLOW_LAW_IN, form, FLOW_WORD_##word)
#define FLOW_LAW_IN(form, kind, with, less, only, mode, law, whose, field)                         \
    FLOW_IN_##form(with, less, law)
#define FLOW_IN_WITH(with, less, member) FLOW_IF_##with(member,)
#define FLOW_IN_LESS(with, less, member) FLOW_IF_##less(member,)

/* The parameters at the fork. */
#define FLOW_PARAMETER(k, word) FLOW_SPREAD(FLOW_PARAMETER_IN, k, FLOW_WORD_##word)
#define FLOW_PARAMETER_IN(k, kind, with, less, only, mode, law, whose, field)                      \
    {whose, FLOW_FIELD_##field},
/* The mode of those whose number varies: one for all of a kernel. */
#define FLOW_FURTHER(k, word) FLOW_SPREAD(FLOW_FURTHER_IN, k, FLOW_WORD_##word)
#define FLOW_FURTHER_IN(k, kind, with, less, only, mode, law, whose, field)                        \
    FLOW_FURTHER_##with##less(mode)
#define FLOW_FURTHER_11(mode)
#define FLOW_FURTHER_10(mode)
#define FLOW_FURTHER_01(mode)
#define FLOW_FURTHER_00(mode) | mode
/* clang-format on */

#define FLOW_KERNEL_BODY(name)                                                                     \
    static int name##_body(const duite_call *call, const struct name##_fields *on)

#define FLOW_KERNEL_OPEN(name, part, arguments, fields)                                            \
    enum { FLOW_EACH(FLOW_INDEX, name, fields) name##_at_end };                                    \
    struct name##_fields {                                                                         \
        const arguments *args;                                                                     \
        FLOW_EACH(FLOW_HAS, name, fields)                                                          \
    };                                                                                             \
    FLOW_KERNEL_BODY(name);                                                                        \
    static int name##_open(const duite_call *call)                                                 \
    {                                                                                              \
        struct name##_fields on = {.args = call->args};                                            \
        size_t next = name##_at_end;                                                               \
        FLOW_EACH(FLOW_OPEN, name, fields)                                                         \
        (void)next;                                                                                \
        return name##_body(call, &on);                                                             \
    }                                                                                              \
    static int name##_task(const duite_call *call)                                                 \
    {                                                                                              \
        return (part) == FLOW_NO_PART ? name##_open(call) : flow_timed(call, name##_open, part);   \
    }                                                                                              \
    _Static_assert(FLOW_KERNEL_##name >= 0 && offsetof(arguments, block) == 0 &&                   \
                       _Generic(((arguments *)NULL)->block, uint32_t : 1, default : 0),            \
                   "a kernel is in the list, and its arguments begin with the block");
#define FLOW_TASK(k, text, form, arguments, fields, ...)                                           \
    {                                                                                              \
        .name = text, .body = k##_task, .access = {FLOW_EACH(FLOW_MODE, form, fields) DUITE_NONE}, \
        .law = (const duite_law *const[]){FLOW_EACH(FLOW_LAW, form, fields) NULL},                 \
        .variadic = 0 FLOW_EACH(FLOW_FURTHER, k, fields), .args_size = sizeof(arguments),          \
        __VA_ARGS__                                                                                \
    }

/* flow_type_of_name: the C type of a field's object. */
#define FLOW_FIELD_TYPE(name, many, type, ...) FLOW_FIELD_TYPE_##many(name, type)
#define FLOW_FIELD_TYPE_ONE(name, type)        typedef type flow_type_of_##name;
#define FLOW_FIELD_TYPE_SIZED(name, type)      typedef type flow_type_of_##name;
#define FLOW_FIELD_TYPE_BY_PASS(name, type)                                                        \
    typedef type flow_type_of_##name, flow_type_of_##name##_next;
struct flow_list;
FLOW_FIELDS(FLOW_FIELD_TYPE)
#define FLOW_OBJECT_TYPE(name, type) typedef type flow_type_of_##name;
FLOW_OBJECTS(FLOW_OBJECT_TYPE)

/* ---- Forks ---- */

/* The fork gives the field `given` where a kernel declares `declared`, of the same shape. */
struct flow_as {
    enum flow_field_id declared, given;
};
/* FLOW_AS(FLOW_FOR(kept_x, base_x), {FLOW_FIELD_kept_v, field}) */
#define FLOW_FOR(declared, given)                                                                  \
    {                                                                                              \
        FLOW_FIELD_##declared, FLOW_FIELD_##given                                                  \
    }
#define FLOW_AS(...)                                                                               \
    ((const struct flow_as[]){__VA_ARGS__, {FLOW_FIELDS_OF_ALL, FLOW_FIELDS_OF_ALL}})

enum { FLOW_FORKS_AHEAD = 8 }; /* forks whose objects are found before the first of them */

/* Fork a kernel with the objects that it declares: on the block that the arguments name, on each
 * block, on the blocks from first to before end, or on a rank. On several blocks they write its
 * number into the arguments; NULL: the kernel needs no others. On each: they call flow_ties_show
 * before a kernel that reads TIED(tie_halo). as: NULL, or FLOW_AS. Collective. They return the
 * first failure of the run. */
int flow_fork_one(struct flow_state *state, const struct flow_kernel *kernel, const void *args);
int flow_fork_one_as(struct flow_state *state, const struct flow_kernel *kernel, const void *args,
                     const struct flow_as *as);
int flow_fork_each(struct flow_state *state, const struct flow_kernel *kernel, void *args);
int flow_fork_each_as(struct flow_state *state, const struct flow_kernel *kernel, void *args,
                      const struct flow_as *as);
int flow_fork_range_as(struct flow_state *state, const struct flow_kernel *kernel, uint32_t first,
                       uint32_t end, void *args, const struct flow_as *as);
int flow_fork_at(struct flow_state *state, int rank, const struct flow_kernel *kernel,
                 const void *args, const struct flow_as *as);

/* The runtime's kernel of a run. */
const duite_kernel *flow_task_of(const struct flow_state *state, const struct flow_kernel *kernel);

/* The objects that a fork gives: those of GIVEN words by name, n of REST. As many objects as a
 * kernel has parameters may be written before `rest`. */
#define FLOW_OBJECT_MEMBER(name, type) duite_object name;
struct flow_with {
    union {
        duite_object of[FLOW_NO_FIELDS];
        struct {
            FLOW_OBJECTS(FLOW_OBJECT_MEMBER)
        };
    };
    size_t n;
    duite_object *rest; /* NULL: none */
};
int flow_fork_with(struct flow_state *state, const struct flow_kernel *kernel, const void *args,
                   const struct flow_with *with);
int flow_fork_with_at(struct flow_state *state, int rank, const struct flow_kernel *kernel,
                      const void *args, const struct flow_with *with);

/* Puts the objects that a fork of the kernel on a block gives into state->refs. Returns how many:
 * for forks that give others in place of some. The second forks with n objects there. */
size_t flow_kernel_objects(struct flow_state *state, const struct flow_kernel *kernel,
                           uint32_t block, const struct flow_as *as);
int flow_fork_listed(struct flow_state *state, const struct flow_kernel *kernel, const void *args,
                     size_t n);

/* In a body: the rows, or the numbers, of neighbour s; of the s-th block that has the field. */
static inline const phys_vec *flow_rows_of(const duite_param *field, size_t s)
{
    return field[s].data;
}
static inline const double *flow_numbers_of(const duite_param *field, size_t s)
{
    return field[s].data;
}

#endif
