/* A checkpoint may have the right hash and still fit no run: every length, count and index is
 * compared with the scene before its use. All functions are pure. */
#include "cloth/flow/checkpoint/checkpoint.h"

#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/mode.h"

#include <math.h>
#include <string.h>

/* No run has more contacts of a block, or items in a meeting; lengths of lists stay in range. */
enum { MOST_ITEMS = 1 << 24 };

/* ---- State of the main program ---- */

static bool is_bool(const bool *value)
{
    unsigned char byte;
    memcpy(&byte, value, sizeof byte);
    return byte <= 1;
}

static bool is_power_of_two(uint32_t n)
{
    return n && !(n & (n - 1));
}

/* Steps begin at multiples of their length, and there is one until the end. */
static bool has_grid(const struct flow_saved *saved)
{
    const struct flow_grid *grid = &saved->lasting.grid;
    return is_power_of_two(grid->length) && grid->length <= FLOW_TICKS &&
           is_power_of_two(grid->least_done) && grid->least_done <= FLOW_TICKS &&
           saved->end % FLOW_TICKS == 0 && grid->end == saved->end && grid->now <= saved->end &&
           grid->now % grid->length == 0;
}

/* A step takes a tick at least. Frames come one after the other. */
static bool has_counts(const struct flow_saved *saved)
{
    const struct flow_lasting *lasting = &saved->lasting;
    const struct flow_report *report = &saved->report;
    return report->steps <= lasting->grid.now && lasting->length <= FLOW_TICKS &&
           lasting->length_before <= FLOW_TICKS && lasting->guessed <= FLOW_TICKS &&
           lasting->smooth <= FLOW_TICKS && lasting->certain.next <= lasting->next_frame &&
           lasting->next_frame <= INT32_MAX && isfinite(lasting->shown) &&
           isfinite(lasting->certain.shown) &&
           memchr(report->contact_pinch, 0, sizeof report->contact_pinch);
}

static bool has_bools(const struct flow_saved *saved)
{
    const struct flow_lasting *lasting = &saved->lasting;
    return saved->has_ties <= 1 && saved->finished <= 1 && is_bool(&lasting->guard.off) &&
           is_bool(&lasting->settled_forces) && is_bool(&lasting->resting) &&
           is_bool(&lasting->sewn) && is_bool(&lasting->over) && is_bool(&saved->report.stopped);
}

/* True if the blocks that a block shares ties with ascend and have room. Places only tell if links
 * changed: flow_ties_adopt finds them again before it makes a table. */
static bool has_others(const struct flow_saved *saved, const struct flow_tied_blocks *tied,
                       uint32_t b)
{
    const struct flow_tie_room *room = tied->room + b;
    const uint32_t first = tied->first[b], end = tied->first[b + 1];
    if (first > end || end > saved->n_others || end - first > room->others ||
        room->others > saved->n_blocks + FLOW_TIE_OTHERS || room->others % FLOW_TIE_OTHERS ||
        room->ties % FLOW_TIE_CLASS || room->rows % FLOW_TIE_CLASS || room->ties > MOST_ITEMS ||
        room->rows > MOST_ITEMS)
        return false;
    for (uint32_t i = first; i < end; i++) {
        const uint32_t other = tied->other[i];
        if (other >= saved->n_blocks || (i > first && other <= tied->other[i - 1]) ||
            tied->place[i] > tied->room[other].rows)
            return false;
    }
    return true;
}

/* All ties there are: of joints that come and go, or of contacts. */
static bool has_ties(const struct flow *flow, const struct flow_saved *saved,
                     const struct flow_tied_blocks *tied)
{
    const uint32_t joints = flow->source.springs.n_timed, n = saved->n_blocks;
    const bool seeks = model_seeks(flow->model);
    if (saved->has_ties != (joints || seeks))
        return false;
    if (!saved->has_ties)
        return !saved->n_others;
    if (saved->n_others > flow_tied_others(n, joints, seeks) || tied->first[0] ||
        tied->first[n] != saved->n_others)
        return false;
    bool whole = true;
    for (uint32_t b = 0; b < n && whole; b++)
        whole = has_others(saved, tied, b);
    return whole;
}

static bool checkpoint_check_has_meetings(const struct flow *flow, const struct flow_saved *saved,
                                          const struct flow_saved_side *side, const uint32_t *kept)
{
    const uint32_t n_sides = saved->n_blocks + flow->model->n_obstacles;
    if (saved->n_kept != (flow_contact_mode(flow->model)->carries ? saved->n_blocks : 0) ||
        (saved->n_meetings && !model_seeks(flow->model)))
        return false;
    for (uint32_t i = 0; i < saved->n_meetings; i++)
        if (side[i].side[0] >= saved->n_blocks || side[i].side[1] < side[i].side[0] ||
            side[i].side[1] >= n_sides || side[i].room > MOST_ITEMS ||
            !is_power_of_two(side[i].room))
            return false;
    for (uint32_t b = 0; b < saved->n_kept; b++)
        if (kept[b] > MOST_ITEMS)
            return false;
    return true;
}

const char *flow_saved_wrong(const struct flow *flow, const unsigned char *bytes)
{
    struct flow_saved saved;
    memcpy(&saved, bytes, sizeof saved);
    const struct flow_saved_arrays arrays = flow_saved_arrays(&saved, bytes);
    if (!has_bools(&saved))
        return "has a flag that is neither on nor off";
    if (!has_grid(&saved))
        return "has a time or a length of a step that no run comes to";
    if (!has_counts(&saved))
        return "counts steps or frames that cannot be";
    if (!has_ties(flow, &saved, &arrays.tied))
        return "has ties between blocks that this scene cannot have";
    if (!checkpoint_check_has_meetings(flow, &saved, arrays.side, arrays.kept))
        return "has contacts between blocks or obstacles that this scene does not have";
    return NULL;
}

/* ---- State of blocks ---- */

bool flow_saved_is_place(const double *numbers, size_t n)
{
    bool is = true;
    for (size_t i = 0; i < n; i++)
        is = is && (i % 4 == 3 || fabs(numbers[i]) <= FLOW_BOUND);
    return is;
}

/* How many points a side has. */
static uint32_t points_of(const struct flow *flow, uint32_t side)
{
    const uint32_t n_blocks = flow->tables.n_blocks;
    if (side < n_blocks)
        return flow->tables.block[side].skin.n_points;
    const uint32_t number = flow->model->obstacles[side - n_blocks].body;
    const struct contact_body *body = contact_bodies_at(&flow->model->bodies, number);
    return body ? body->n_vertices : 0;
}

static bool checkpoint_check_has_corners(const struct flow *flow, const struct flow_tie_corners *at)
{
    for (uint32_t k = 0; k < at->n; k++)
        if (at->block[k] >= flow->tables.n_blocks ||
            at->row[k] >= flow->tables.block[at->block[k]].n || !isfinite(at->weight[k]))
            return false;
    return true;
}

/* Corners of a shape are those of the first side alone; pairs have four of both. */
static bool has_points(const struct flow *flow, const struct flow_contact *contact)
{
    const bool on_shape = contact->kind == FLOW_CONTACT_SHAPE;
    const uint32_t n = on_shape ? contact->at.n : SOLVE_TIE_CORNERS;
    for (uint32_t k = 0; k < n; k++)
        if (contact->point[k] >= points_of(flow, contact->side[k >= contact->first]))
            return false;
    return true;
}

static bool is_contact(const struct flow *flow, uint32_t block, const struct flow_contact *contact)
{
    const uint32_t n_blocks = flow->tables.n_blocks, other = contact->side[1];
    const bool on_shape = contact->kind == FLOW_CONTACT_SHAPE;
    if (contact->side[0] != block || other >= n_blocks + flow->model->n_obstacles ||
        !contact->at.n || contact->at.n > SOLVE_TIE_CORNERS || !contact->first ||
        contact->first > SOLVE_TIE_CORNERS)
        return false;
    if (on_shape ? other < n_blocks || contact->at.n != contact->first
                 : contact->kind > CONTACT_TV || contact->first == SOLVE_TIE_CORNERS ||
                       contact->at.n != (other < n_blocks ? SOLVE_TIE_CORNERS : contact->first))
        return false;
    return has_points(flow, contact) && checkpoint_check_has_corners(flow, &contact->at);
}

bool flow_saved_are_contacts(const struct flow *flow, uint32_t block, const unsigned char *bytes,
                             size_t n)
{
    struct flow_list list;
    struct flow_contact contact;
    if (n < sizeof list)
        return false;
    memcpy(&list, bytes, sizeof list);
    if (list.n > (n - sizeof list) / sizeof contact)
        return false;
    for (size_t i = 0; i < list.n; i++) {
        memcpy(&contact, bytes + flow_list_bytes(i, sizeof contact), sizeof contact);
        if (!is_contact(flow, block, &contact))
            return false;
    }
    return true;
}
