/* Shapes at rest that change in time. In a step they are those at its end, whatever the integrator,
 * so a table that is made again, and changed for the next step, has the same bits: each number
 * follows from that by the mesh. */
#include "cloth/flow/run/step.h"
#include "cloth/flow/state/bodies.h"

/* A spring's stiffness is modulus times area over length squared; in grids it is the modulus. */
static void resize_spring(const struct flow_sized *sized, const struct element_scale *scale,
                          const struct flow_layout *layout, uint32_t i)
{
    const double part = sized->size.keeps ? 1 : scale->area / scale->square;
    layout->stiffness[i] = sized->base[0] * part;
    layout->damping[i] = sized->base[1] * part;
    layout->length[i] = sized->base[2] * sqrt(scale->square);
}

static void resize_element(const struct flow_sized *sized, const struct element_scale *scale,
                           const struct element_kind *kind, const struct phys_elements *list,
                           uint32_t e)
{
    if (kind->vectors)
        list->vector[e] =
            (phys_vec){sized->base[0], sized->base[1], sized->base[2], sized->base[3]};
    for (uint32_t i = 0; i < kind->numbers; i++)
        list->number[i][e] = sized->base[4 + i];
    kind->resize(list, e, scale);
}

static bool changes(const struct flow_sized *sized)
{
    return sized->size.curve[0] || sized->size.curve[1];
}

FLOW_KERNEL(resize, FLOW_NO_PART, struct flow_step_args, (RW(table)))
{
    const struct flow_table *t = flow_shape_of(call);
    const struct model *model = flow_of(call)->model;
    const struct flow_layout layout = flow_table_layout(t, on->table);
    const struct flow_sized *sized = layout.sized;
    for (uint32_t i = 0; i < t->n_inner + t->n_cut; i++, sized++)
        if (changes(sized)) {
            const struct element_scale scale =
                element_scale_at(model, &sized->size, on->args->time);
            resize_spring(sized, &scale, &layout, i);
        }
    for (int i = 0; i < ELEMENT_KINDS; i++)
        for (uint32_t e = 0; element_kinds[i]->resize && e < t->n_elements[i]; e++, sized++)
            if (changes(sized)) {
                const struct element_scale scale =
                    element_scale_at(model, &sized->size, on->args->time);
                resize_element(sized, &scale, element_kinds[i], layout.list + i, e);
            }
    return 0;
}

int flow_resize(struct flow_state *state)
{
    struct flow_step_args args = flow_attempt_args(state);
    return flow_fork_each(state, &flow_kernel_resize, &args);
}
