/* One pair of features of two skins: it is certified, told if its certificate fails, and listed if
 * it is near at the end of the step and presses.
 *
 * All that a look finds of a pair follows from the ways of its points. Another look at the step
 * passes over pairs whose points have the same bits: they are certified already. */
#include "cloth/flow/contact/meeting.h"

#include "cloth/contact/certificate.h"
#include "cloth/contact/push.h"
#include "cloth/flow/contact/body.h"
#include "cloth/flow/contact/mode.h"

#include <math.h>

/* Part of the distance at rest to the nearest edge: kin that are nearer push. Cloth on its plane
 * does not contract by as much. */
static const double CLEAR = 0.5;

/* The corners of two features, and their positions. */
struct corners {
    const struct contact_candidate *candidate;
    enum contact_pair pair;
    uint32_t point[4];
    unsigned char side[4];
    const phys_vec *x, *y; /* 4 */
    unsigned held;         /* bit k: corner k cannot be cut */
    double thickness;      /* m: that keeps them apart */
};

/* Only listed pairs need it. */
static void find_held_corners(const struct meeting *m, struct corners *to)
{
    to->held = 0;
    for (unsigned k = 0; k < 4; k++)
        to->held |= (unsigned)(m->skin[to->side[k]].held[to->point[k]] != 0) << k;
}

/* The cloth, or behind all cloths the obstacle, that n corners are of, from one on. */
static uint32_t contact_meet_side_of(const struct meeting *m, const uint32_t point[4],
                                     const unsigned char side[4], uint32_t from, uint32_t n)
{
    return m->body && side[from] ? m->flow->n_cloths + (m->args->side[1] - m->flow->tables.n_blocks)
                                 : flow_cloth_of(m->skin + side[from], n, point + from);
}

/* True if a point moved since the last look at the step. */
static bool point_moved(const struct meeting *m, int side, uint32_t point)
{
    return m->moved[side] && m->moved[side][point];
}

static bool candidate_moved(const struct meeting *m, const struct corners *corners)
{
    bool moved = false;
    for (int k = 0; k < 4; k++)
        moved = moved || point_moved(m, corners->side[k], corners->point[k]);
    return moved;
}

bool flow_meeting_moved(const struct meeting *m, const struct flow_contact *contact)
{
    bool moved = false;
    for (uint32_t k = 0; k < 4; k++)
        moved = moved || point_moved(m, contact->side[k >= contact->first] != m->args->side[0],
                                     contact->point[k]);
    return moved;
}

static const struct model_sides *sides_of(const struct meeting *m, const struct corners *corners)
{
    const uint32_t n = corners->pair == CONTACT_EE ? 2 : 1; /* of the first one's corners */
    const uint32_t a = contact_meet_side_of(m, corners->point, corners->side, 0, n),
                   b = contact_meet_side_of(m, corners->point, corners->side, n, 4 - n);
    return a < m->flow->n_cloths ? flow_sides_of(m->flow, a, b) : flow_sides_of(m->flow, b, a);
}

/* m: that keeps two features apart which are no kin. */
static double thickness_of(const struct meeting *m, const struct corners *corners)
{
    const bool alike = !(m->thickness.least < m->thickness.most);
    return alike ? m->thickness.most : sides_of(m, corners)->thickness;
}

/* True for a body's vertex and a block's triangle: the triangle comes first. */
static bool contact_meet_is_turned(const struct meeting *m, const struct corners *corners)
{
    return m->body && corners->side[0] == 1;
}

/* Corner k of those that are kept, `from` of the pair. Those of a body have no rows. */
static void describe_corner(const struct corners *corners, const struct contact_skin *skin,
                            uint32_t k, uint32_t from, struct flow_contact *to)
{
    const uint32_t point = corners->point[from];
    to->point[k] = point;
    if (k >= to->at.n)
        return;
    to->at.block[k] = skin->block[point];
    to->at.row[k] = skin->row[point];
    to->at.held |= (unsigned char)((corners->held >> from & 1) << k);
}

/* The area that a contact presses: that of the cloth at its first side's point. Between two cloths
 * it is half of that, as contacts of the other one's features press the same place. */
static double contact_meet_area(const struct meeting *m, const struct corners *corners,
                                const struct flow_contact *of)
{
    double area = 0;
    for (uint32_t k = 0; k < of->first; k++) {
        const uint32_t from = (k + contact_meet_is_turned(m, corners)) % 4;
        area += of->at.weight[k] * m->area[corners->side[from]][of->point[k]];
    }
    return m->body ? area : 0.5 * area;
}

/* The clearance at rest around corner k: m if n others from one on are its kin, else INFINITY. */
static double clear_of(const struct meeting *m, const struct corners *corners, int k, int from,
                       uint32_t n)
{
    const struct flow_skin_kin *kin = m->kin + corners->side[k];
    uint32_t joined[3];
    for (uint32_t i = 0; i < n; i++)
        joined[i] = m->skin[corners->side[from]].joined[corners->point[(uint32_t)from + i]];
    return flow_kin_has(kin, corners->point[k], n, joined) ? kin->clear[corners->point[k]]
                                                           : INFINITY;
}

/* The thickness of kin (kin.c), which are near at rest: they do not push there, nor where cloth
 * bends, and their certificate asks for as much less. */
static void contact_meet_thin(const struct meeting *m, struct corners *corners)
{
    double clear = INFINITY;
    if (m->body || (!m->kin[0].n && !m->kin[1].n))
        return;
    if (corners->pair == CONTACT_VT)
        clear = clear_of(m, corners, 0, 1, 3);
    for (int k = 0; k < 4 && corners->pair == CONTACT_EE; k++)
        clear = fmin(clear, clear_of(m, corners, k, k < 2 ? 2 : 0, 2));
    corners->thickness = fmin(fmax(CLEAR * clear, CONTACT_MARGIN), corners->thickness);
}

double flow_meeting_kin_reach(const struct meeting *m)
{
    double most = 0;
    for (int k = 0; k < 2; k++)
        for (uint32_t i = 0; i < m->skin[k].n_points && m->kin[k].n; i++)
            most = isinf(m->kin[k].clear[i]) ? most : fmax(most, m->kin[k].clear[i]);
    return CLEAR * most / m->thickness.most * m->reach;
}

/* Fills a contact, in zeroed memory. places: of the corners; they give the row's origin. */
static void contact_meet_describe_pair(const struct meeting *m, const struct corners *corners,
                                       const phys_vec places[4],
                                       const struct contact_nearest *nearest,
                                       struct flow_contact *to)
{
    const int second = corners->side[0]; /* 1: of a triangle of the first side and a vertex */
    const struct model_sides *sides = sides_of(m, corners);
    const bool turned = contact_meet_is_turned(m, corners);
    const double sign = turned ? -1 : 1;
    to->kind = turned ? (uint32_t)CONTACT_TV : (uint32_t)corners->pair;
    to->first = corners->pair == CONTACT_EE ? 2 : (turned ? 3 : 1);
    to->at.n = m->body ? to->first : 4;
    to->row.normal = sign * nearest->normal;
    to->row.gap = nearest->gap;
    to->row.thickness = corners->thickness;
    to->row.friction = sides->friction;
    for (int k = 0; k < 2; k++) {
        to->side[k] = m->args->side[turned ? k : k ^ second];
        to->feature[k] = corners->candidate->of[k ^ second];
    }
    for (uint32_t k = 0; k < 4; k++) {
        const uint32_t from = (k + turned) % 4;
        to->at.weight[k] = sign * nearest->weight[from];
        describe_corner(corners, m->skin + corners->side[from], k, from, to);
        if (k < to->at.n)
            to->row.origin += to->at.weight[k] * places[from];
    }
    to->row.hard = sides->pressure * contact_meet_area(m, corners, to);
}

/* True if a feature of the block and one of a body, whose surface goes on all around, press. They
 * do if the nearest point is inside the block's feature, and the direction there is in the cone
 * that the body leaves open. Other pairs are those of a neighbour, seen aslant: they would hold up
 * cloth that slides over an edge. Where the body is flat, vertices of the cloth are nearer to it
 * than its edges and triangles are. */
static bool presses_body(const struct meeting *m, const struct corners *corners,
                         const struct contact_nearest *nearest)
{
    const bool turned = contact_meet_is_turned(m, corners);
    const phys_vec normal = turned ? -nearest->normal : nearest->normal;
    uint32_t n = 0, vertex[3];
    phys_vec point = {0};
    bool inside = true;
    for (int k = 0; k < 4; k++) {
        const double weight = fabs(nearest->weight[k]);
        const bool of_body = corners->side[k];
        inside = inside && (of_body || weight > 0);
        if (!of_body || !(weight > 0))
            continue;
        point += weight * corners->y[k];
        vertex[n++] = corners->point[k];
    }
    const phys_vec *y = m->side[1].y;
    const bool one = corners->pair == CONTACT_VT && !turned; /* a vertex of the cloth is nearer */
    return inside && contact_body_opens(m->body, m->fan, y, n, vertex, &point, &normal) &&
           (one || contact_body_bends(m->body, m->fan, y, n, vertex));
}

/* True if two features are nearest inside both: a vertex is above the inside of a triangle, edges
 * cross. */
static bool contact_meet_is_inside(const struct contact_nearest *nearest)
{
    bool inside = true;
    for (int k = 0; k < 4; k++)
        inside = inside && nearest->weight[k] != 0;
    return inside;
}

/* True if two features are a contact at the end of the step. A vertex beside a triangle is a
 * contact only if it is too near: its plane would hold up cloth that slides over an edge. An edge
 * that is nearest at its end is such a vertex. */
static bool presses(const struct meeting *m, const struct corners *corners,
                    const struct contact_nearest *nearest)
{
    const double part = corners->thickness / m->thickness.most;
    if (!(nearest->gap < part * m->reach))
        return false;
    if (m->body)
        return presses_body(m, corners, nearest);
    if (corners->pair != CONTACT_EE)
        return contact_meet_is_inside(nearest) || nearest->gap < corners->thickness;
    const uint32_t *edge = corners->candidate->of;
    const phys_vec normal = nearest->normal, back = -normal;
    return contact_meet_is_inside(nearest) &&
           contact_is_ridge(m->skin, m->side[0].y, edge[0], &normal) &&
           contact_is_ridge(m->skin + 1, m->side[1].y, edge[1], &back);
}

/* Appends a pair that is near at the end of the step. */
static void list_pair(struct meeting *m, struct corners *corners,
                      const struct contact_nearest *nearest)
{
    struct flow_near near;
    memset(&near, 0, sizeof near); /* padding, too: lists are compared byte by byte */
    find_held_corners(m, corners);
    contact_meet_describe_pair(m, corners, corners->y, nearest, &near.contact);
    for (uint32_t k = 0; k < 4; k++)
        near.part[k] = 1;
    flow_findings_add(&m->findings, &near);
}

/* The gap at the step's end, along the normal of its begin. */
static double gap_ahead(const struct corners *corners, const struct contact_nearest *nearest)
{
    phys_vec way = {0};
    for (int k = 0; k < 4; k++)
        way += nearest->weight[k] * (corners->y[k] - corners->x[k]);
    return nearest->gap + phys_dot(&nearest->normal, &way);
}

/* Appends a pair that the step drives into each other. The parts stay 1 if no cut helps: the pair
 * fails again in the next look, and the step is given up after the last one. */
static void fail_pair(struct meeting *m, struct corners *corners)
{
    double part[4] = {1, 1, 1, 1};
    struct contact_nearest nearest;
    struct flow_near near;
    memset(&near, 0, sizeof near);
    find_held_corners(m, corners);
    contact_nearest_of(corners->pair, corners->x, &nearest);
    contact_meet_describe_pair(m, corners, corners->x, &nearest, &near.contact);
    near.fails = true;
    near.presses = true;
    near.contact.row.firm = contact_row_firm_for(&near.contact.row, gap_ahead(corners, &nearest));
    near.apart = contact_push_gap(nearest.gap, thickness_of(m, corners));
    (void)contact_cut(corners->pair, corners->x, corners->y, corners->thickness, corners->held,
                      part);
    for (uint32_t k = 0; k < 4; k++)
        near.part[k] = part[(k + contact_meet_is_turned(m, corners)) % 4];
    for (uint32_t k = 0; k < 4; k++) {
        const uint32_t from = (k + contact_meet_is_turned(m, corners)) % 4;
        const phys_vec way = corners->y[from] - corners->y[0];
        near.along[k] = phys_dot(&nearest.normal, &way);
    }
    flow_findings_add(&m->findings, &near);
}

static void look_at_pair(struct meeting *m, struct corners *corners, enum contact_passing passing)
{
    struct contact_nearest nearest;
    if (passing != CONTACT_PASSES_BY)
        contact_meet_thin(m, corners);
    if (passing == CONTACT_MAY_TOUCH && corners->thickness < m->thickness.most)
        passing = contact_pass(corners->pair, corners->x, corners->y, corners->thickness, m->reach);
    if (passing == CONTACT_MAY_TOUCH) {
        fail_pair(m, corners);
        return;
    }
    m->passes++;
    if (passing == CONTACT_PASSES_BY || !corners->candidate->presses)
        return;
    contact_nearest_of(corners->pair, corners->y, &nearest);
    if (presses(m, corners, &nearest))
        list_pair(m, corners, &nearest);
}

/* True if the two sides do not meet, or the block's feature is attached to the body. */
static bool contact_meet_is_left_out(const struct meeting *m, const struct corners *corners)
{
    const uint32_t *point = corners->point;
    const unsigned char *side = corners->side;
    if (sides_of(m, corners)->friction < 0)
        return true;
    const uint32_t n = corners->pair == CONTACT_EE ? 2 : 1, from = side[0] ? n : 0;
    return m->body && flow_is_attached(m->attached, side[0] ? 4 - n : n, point + from,
                                       m->args->side[1] - m->flow->tables.n_blocks);
}

/* Brings the corners of a candidate; false: it is not looked at. */
static bool bring_corners(const struct meeting *m, const struct contact_candidate *candidate,
                          struct corners *to, struct contact_moving *moving)
{
    *to = (struct corners){.candidate = candidate, .x = moving->x, .y = moving->y};
    to->pair = moving->pair =
        contact_candidate_corners(m->skin, m->skin + 1, candidate, to->point, to->side);
    if ((m->args->again && !candidate_moved(m, to)) ||
        (m->leaves_out && contact_meet_is_left_out(m, to)))
        return false;
    to->thickness = thickness_of(m, to);
    for (unsigned k = 0; k < 4; k++) {
        const struct contact_side *side = m->side + to->side[k];
        moving->x[k] = side->x[to->point[k]];
        moving->y[k] = side->y[to->point[k]];
    }
    return true;
}

/* Corners of several candidates are brought before they are certified at once. */
void flow_meeting_visit(void *to, uint32_t n, const struct contact_candidate *candidate)
{
    enum { AT_ONCE = 32 };
    struct meeting *m = to;
    struct corners corners[AT_ONCE];
    struct contact_moving moving[AT_ONCE];
    enum contact_passing passing[AT_ONCE];
    for (uint32_t i = 0; i < n;) {
        const bool parted = candidate[i].parted;
        uint32_t some = 0;
        for (; i < n && some < AT_ONCE && candidate[i].parted == parted; i++)
            some += bring_corners(m, candidate + i, corners + some, moving + some);
        for (uint32_t k = 0; k < some && parted; k++)
            passing[k] = CONTACT_PASSES;
        if (!parted)
            contact_pass_all(some, moving, m->thickness.most, m->reach, passing);
        for (uint32_t k = 0; k < some; k++)
            look_at_pair(m, corners + k, passing[k]);
    }
}
