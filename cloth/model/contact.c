/* The promises of each mode of contact are one table; the rest follows from it and from the
 * scene. */
#include "cloth/model/contact.h"

#include "cloth/model/model.h"

#include <math.h>

const struct model_contact_is model_contact_is[MODEL_CONTACT_MODES] = {
    [MODEL_CONTACT_PROJECT] = {.solves = false},
    [MODEL_CONTACT_REPULSION] = {.no_maps = ", which looks for the nearest points of bodies",
                                 .promise = {.near = true, .springs = true}},
    [MODEL_CONTACT_CERTIFIED] = {.solves = true,
                                 .no_maps = ": maps of its front and back do not show all of it, "
                                            "so nothing can be proven of them",
                                 .promise = {.near = true, .apart = true, .force = true}}};

const struct model_word model_contact_modes[] = {{"certified", MODEL_CONTACT_CERTIFIED},
                                                 {"repulsion", MODEL_CONTACT_REPULSION},
                                                 {"project", MODEL_CONTACT_PROJECT},
                                                 {0}};

/* Springs look even where nothing can touch. */
struct model_promise model_promise(const struct model *model)
{
    const struct model_contact_is *is = model_contact_is + model->contact.mode;
    const struct model_promise nothing = {0};
    if ((is->solves && !model_is_implicit(model)) || (is->promise.apart && model->contact.idle))
        return nothing;
    return is->promise;
}

bool model_shows_contact(const struct model *model)
{
    return model->contact.force && model_promise(model).force;
}

bool model_feels_contact(const struct model *model)
{
    bool feels = false;
    for (uint32_t i = 0; i < model->n_probes; i++) {
        const struct model_probe *probe = model->probes + i;
        feels = feels || probe->contact || probe->contact_total || probe->by_obstacle;
    }
    return feels && model_promise(model).force;
}

bool model_has_maps(const struct model *model)
{
    bool has = false;
    for (uint32_t i = 0; i < model->n_obstacles; i++)
        has = has || model->obstacles[i].view.height;
    return has;
}

bool model_meets(const struct model *model, uint32_t cloth, uint32_t other)
{
    return !contact_are_apart(&model->contact.apart, cloth, other) &&
           (cloth != other || model->contact.self);
}

/* The properties of a side, by its number among materials, then obstacles. */
static struct model_sides find_side(const struct model *model, uint32_t of)
{
    const struct model_contact *all = &model->contact;
    struct model_sides side = {0};
    if (of < model->n_materials) {
        const struct model_material *is = model->materials + of;
        side = (struct model_sides){is->friction, is->thickness, is->pressure};
    } else {
        const struct contact_shape *is = model->obstacles + (of - model->n_materials);
        side = (struct model_sides){is->friction, is->thickness, 0};
    }
    side.thickness = side.thickness > 0 ? side.thickness : all->thickness;
    side.pressure = side.pressure > 0 ? side.pressure : all->pressure;
    return side;
}

/* Half of a, compressed by q, is a / 2 / (1 + q / p). The halves of both together are half as thick
 * by the q > 0 with q^2 - uneven (p_a - p_b) q - p_a p_b = 0, where uneven is (a - b) / (a + b). */
static double press_together(const struct model_sides *a, const struct model_sides *b)
{
    const double uneven = (a->thickness - b->thickness) / (a->thickness + b->thickness);
    const double half = uneven * (a->pressure - b->pressure) / 2;
    return half + sqrt(half * half + a->pressure * b->pressure);
}

struct model_sides model_sides(const struct model *model, uint32_t cloth, uint32_t other)
{
    const bool is_cloth = other < model->n_cloths;
    const uint32_t a = model->cloths[cloth].material;
    const uint32_t b =
        is_cloth ? model->cloths[other].material : model->n_materials + (other - model->n_cloths);
    const struct model_sides own = find_side(model, a);
    struct model_sides that = find_side(model, b);
    that.pressure = is_cloth ? that.pressure : own.pressure;
    struct model_sides both = {.friction = sqrt(own.friction * that.friction),
                               .thickness = (own.thickness + that.thickness) / 2,
                               .pressure = press_together(&own, &that)};
    for (uint32_t i = 0; i < model->contact.n_pairs; i++) {
        const struct model_rub *pair = model->contact.pairs + i;
        if ((pair->of[0] == a && pair->of[1] == b) || (pair->of[0] == b && pair->of[1] == a))
            both.friction = pair->friction;
    }
    return both;
}

const char *model_contact_name(const struct model *model)
{
    return model_word_of(model_contact_modes, (int)model->contact.mode);
}

const char *model_contact_cure(const struct model *model)
{
    return model->contact.assumed
               ? "; contact is certified by default in this scene, contact: {mode: project} is "
                 "the way without"
               : "";
}

const char *model_start_cure(const struct model *model)
{
    for (uint32_t c = 0; c < model->n_cloths; c++)
        if (model->cloths[c].n_unjoined)
            return "join what lies on another's place, by mesh: {weld: 1e-5}";
    return "move them apart, or write contact: {untangle: on}";
}
