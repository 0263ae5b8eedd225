/* Two skins meet: every pair of their features that may come near each other in the step is
 * certified. Those that are near at its end are listed, and those whose certificate fails. A block
 * may meet itself, another block or a body. The order of the list is that of the query, so it is
 * the same for every mapping. */
#include "cloth/flow/contact/body.h"
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/state/skin.h"

#include "cloth/contact/certificate.h"

#include <math.h>

/* What the visits of a query work on. */
struct meeting {
    const struct flow *flow;
    const struct model *model;
    const struct flow_meet_args *args;
    const struct contact_shape *obstacle; /* the body that it is with; NULL: a block */
    const struct contact_body *body;
    const uint32_t *fan; /* of the body (contact_body_opens) */
    struct contact_skin skin[2];
    struct contact_side side[2]; /* of a block that meets itself: both */
    struct flow_near *near;
    size_t n, room; /* found; there is room for */
    double *counts;
};

/* Of two features: their corners, and where these are. */
struct corners {
    enum contact_pair pair;
    uint32_t point[4];
    unsigned char side[4];
    phys_vec x[4], y[4];
    unsigned held; /* bit k: corner k cannot be cut */
};

static void find_corners(const struct meeting *m, const struct contact_candidate *candidate,
                         struct corners *to)
{
    to->pair = contact_candidate_corners(m->skin, m->skin + 1, candidate, to->point, to->side);
    to->held = 0;
    for (unsigned k = 0; k < 4; k++) {
        const struct contact_side *side = m->side + to->side[k];
        to->x[k] = side->x[to->point[k]];
        to->y[k] = side->y[to->point[k]];
        to->held |= (unsigned)(side->skin->held[to->point[k]] != 0) << k;
    }
}

/* Of the two features. */
static double friction_of(const struct meeting *m, const struct corners *corners)
{
    double product = 1;
    for (int k = 0; k < 4; k += 3) /* a corner of each */
        product *= m->body && corners->side[k]
                       ? m->obstacle->friction
                       : flow_friction_of(m->flow, m->skin + corners->side[k], corners->point[k]);
    return sqrt(product);
}

/* Of a body's vertex and a triangle of the block the latter comes first. */
static bool is_turned(const struct meeting *m, const struct corners *corners)
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

/* What is kept of them, in memory that is zero. places: of the corners, where its row begins. */
static void describe(const struct meeting *m, const struct contact_candidate *candidate,
                     const struct corners *corners, const phys_vec places[4],
                     const struct contact_nearest *nearest, struct flow_contact *to)
{
    const int second = corners->side[0]; /* 1: of a triangle of the first side and a vertex */
    const bool turned = is_turned(m, corners);
    const double sign = turned ? -1 : 1;
    to->kind = turned ? (uint32_t)CONTACT_TV : (uint32_t)corners->pair;
    to->first = corners->pair == CONTACT_EE ? 2 : (turned ? 3 : 1);
    to->at.n = m->body ? to->first : 4;
    to->row.normal = sign * nearest->normal;
    to->row.gap = nearest->gap;
    to->row.thickness = m->model->contact.thickness;
    to->row.friction = friction_of(m, corners);
    for (int k = 0; k < 2; k++) {
        to->side[k] = m->args->side[turned ? k : k ^ second];
        to->feature[k] = candidate->of[k ^ second];
    }
    for (uint32_t k = 0; k < 4; k++) {
        const uint32_t from = (k + turned) % 4;
        to->at.weight[k] = sign * nearest->weight[from];
        describe_corner(corners, m->skin + corners->side[from], k, from, to);
        if (k < to->at.n)
            to->row.origin += to->at.weight[k] * places[from];
    }
}

static void append(struct meeting *m, const struct flow_near *near)
{
    const bool first = near->contact.side[0] == m->args->side[0];
    if (m->n < m->room)
        m->near[m->n] = *near;
    m->n++;
    m->counts[FLOW_COUNT_FAILS] += near->fails;
    m->counts[first ? FLOW_COUNT_FIRST : FLOW_COUNT_SECOND]++;
}

/* Whether a surface has a ridge at an edge, towards what is nearest to it: on a flat or hollow one
 * vertices and triangles are nearer than the edge is, and a contact of their own is enough. At a
 * border of the cloth, or of what the skin knows, there is one triangle or none: a flat one counts.
 * sign: 1 where the normal points away from what is nearest, else -1. */
static bool is_ridge(const struct meeting *m, int side, uint32_t edge, const phys_vec *normal,
                     double sign)
{
    static const double FLAT = 0.05; /* sine of an angle */
    const struct contact_skin *skin = m->skin + side;
    const phys_vec *y = m->side[side].y, *from = y + skin->edge[edge][0];
    const phys_vec along = y[skin->edge[edge][1]] - *from;
    const double square = phys_dot(&along, &along);
    const bool border = skin->beside[edge][1] == CONTACT_NO_POINT;
    bool ridge = true;
    for (int k = 0; k < 2 && skin->beside[edge][k] != CONTACT_NO_POINT; k++) {
        const phys_vec to = y[skin->beside[edge][k]] - *from;
        const phys_vec across = to - phys_dot(&to, &along) / square * along;
        const double up = sign * phys_dot(&across, normal);
        ridge = ridge && up > (border ? -FLAT : FLAT) * sqrt(phys_dot(&across, &across));
    }
    return ridge;
}

/* The same of a feature of the block and one of a body, whose surface goes on all around. It is one
 * if the nearest point is inside the block's feature, and the direction there is in the cone that
 * the body leaves open. Others are those of a neighbour of a feature, seen aslant: they would hold
 * up what slides over an edge. */
static bool presses_body(const struct meeting *m, const struct corners *corners,
                         const struct contact_nearest *nearest)
{
    const bool turned = is_turned(m, corners);
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
    return inside && contact_body_opens(m->body, m->fan, m->side[1].y, n, vertex, &point, &normal);
}

/* Whether a vertex is above the inside of a triangle. */
static bool is_above(const struct contact_nearest *nearest)
{
    return nearest->weight[1] != 0 && nearest->weight[2] != 0 && nearest->weight[3] != 0;
}

/* Whether two features are a contact at the end of the step. A vertex beside a triangle is one
 * where it is too near alone: the plane across the way to it would hold up what slides over an
 * edge. */
static bool presses(const struct meeting *m, const struct contact_candidate *candidate,
                    const struct corners *corners, const struct contact_nearest *nearest)
{
    if (!(nearest->gap < flow_contact_reach(m->model)))
        return false;
    if (m->body)
        return presses_body(m, corners, nearest);
    if (candidate->kind != CONTACT_EE)
        return is_above(nearest) || nearest->gap < m->model->contact.thickness;
    return is_ridge(m, 0, candidate->of[0], &nearest->normal, 1) &&
           is_ridge(m, 1, candidate->of[1], &nearest->normal, -1);
}

static void list(struct meeting *m, const struct contact_candidate *candidate,
                 const struct corners *corners, const phys_vec places[4],
                 const struct contact_nearest *nearest, bool fails)
{
    double part[4] = {1, 1, 1, 1};
    struct flow_near near;
    memset(&near, 0, sizeof near); /* padding, too: lists are compared byte by byte */
    near.fails = fails;
    describe(m, candidate, corners, places, nearest, &near.contact);
    if (fails)
        contact_cut(corners->pair, corners->x, corners->y, m->model->contact.thickness,
                    corners->held, part);
    for (uint32_t k = 0; k < 4; k++)
        near.part[k] = part[(k + is_turned(m, corners)) % 4];
    append(m, &near);
}

static void look_at(struct meeting *m, const struct contact_candidate *candidate)
{
    struct contact_nearest nearest;
    struct corners corners;
    find_corners(m, candidate, &corners);
    if (!contact_certify(corners.pair, corners.x, corners.y, m->model->contact.thickness)) {
        contact_nearest_of(corners.pair, corners.x, &nearest);
        list(m, candidate, &corners, corners.x, &nearest, true);
        return;
    }
    contact_nearest_of(corners.pair, corners.y, &nearest);
    if (presses(m, candidate, &corners, &nearest))
        list(m, candidate, &corners, corners.y, &nearest, false);
}

/* Whether a cloth that does not meet itself is on both sides. */
static bool is_left_out(const struct meeting *m, const struct contact_candidate *candidate)
{
    uint32_t point[4];
    unsigned char side[4];
    if (m->model->contact.self || m->body)
        return false;
    contact_candidate_corners(m->skin, m->skin + 1, candidate, point, side);
    return m->skin[side[0]].cloth[point[0]] == m->skin[side[3]].cloth[point[3]];
}

static void visit(void *to, uint32_t n, const struct contact_candidate *candidate)
{
    struct meeting *m = to;
    for (uint32_t i = 0; i < n; i++)
        if (!is_left_out(m, candidate + i))
            look_at(m, candidate + i);
}

/* Parameters: w the list, cw the counts, then of each block, or of all bodies, skins, points,
 * boxes; behind those of bodies their fans. */
enum { AT_LIST, AT_COUNTS, AT_SIDES, EACH_SIDE = 3 };

static void open_side(const duite_call *call, size_t at, struct contact_skin *skin,
                      struct contact_side *side)
{
    *skin = flow_skin_open(duite_in(call, at, unsigned char)).skin;
    const phys_vec *points = duite_in(call, at + 1, phys_vec);
    *side = (struct contact_side){.skin = skin,
                                  .boxes = duite_in(call, at + 2, unsigned char),
                                  .x = points,
                                  .y = points + skin->n_points};
}

static void open_sides(const duite_call *call, struct meeting *m)
{
    const uint32_t n_blocks = m->flow->tables.n_blocks, *side = m->args->side;
    const size_t other = AT_SIDES + (side[0] != side[1] ? EACH_SIDE : 0);
    open_side(call, AT_SIDES, m->skin, m->side);
    if (side[1] < n_blocks) {
        open_side(call, other, m->skin + 1, m->side + 1);
        return;
    }
    m->obstacle = m->model->obstacles + (side[1] - n_blocks);
    m->body = contact_bodies_at(&m->model->bodies, m->obstacle->body);
    m->fan = duite_in(call, other + EACH_SIDE, uint32_t) +
             flow_body_place(m->model, side[1] - n_blocks).vertex;
    flow_body_open(m->model, side[1] - n_blocks, duite_in(call, other, unsigned char),
                   duite_in(call, other + 1, phys_vec), duite_in(call, other + 2, unsigned char),
                   m->skin + 1, m->side + 1);
}

static int meet(const duite_call *call)
{
    const struct flow_meet_args *args = call->args;
    struct flow_list *list = duite_out(call, AT_LIST, struct flow_list);
    struct meeting m = {.flow = flow_of(call),
                        .model = flow_of(call)->model,
                        .args = args,
                        .near = (struct flow_near *)(list + 1),
                        .room = args->room,
                        .counts = duite_out(call, AT_COUNTS, double) +
                                  (size_t)FLOW_COUNTS * args->number};
    const bool alone = args->side[0] == args->side[1];
    open_sides(call, &m);
    contact_query(m.side, alone ? m.side : m.side + 1, flow_contact_reach(m.model), visit, &m);
    m.counts[FLOW_COUNT_ALL] = (double)m.n;
    *list = (struct flow_list){.n = m.n < m.room ? m.n : m.room,
                               .side = {args->side[0], args->side[1]}};
    return duite_resize(call, AT_LIST, flow_list_bytes(list->n, sizeof *m.near));
}

static int meet_timed(const duite_call *call)
{
    return flow_timed(call, meet, FLOW_COLLIDE);
}
const duite_kernel flow_meet = {.name = "meet",
                                .body = meet_timed,
                                .access = {DUITE_W, DUITE_CW},
                                .law = {NULL, &duite_sum},
                                .variadic = DUITE_R,
                                .args_size = sizeof(struct flow_meet_args)};
