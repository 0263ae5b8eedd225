#ifndef CLOTH_UNTANGLE_STATE_H
#define CLOTH_UNTANGLE_STATE_H

#include "cloth/base/memory.h"
#include "cloth/contact/skin.h"
#include "cloth/untangle/untangle.h"
#include "cloth/verify/verify.h"

#include <math.h>

/* Shared by the files of this folder: one soup of all cloths, then of all bodies. Local. */

#define UNTANGLE_NONE UINT32_MAX

/* An edge of the triangles; each is listed once. */
struct untangle_edge {
    uint32_t end[2];
    uint32_t opposite[2]; /* third corners of its triangles; UNTANGLE_NONE */
    uint32_t n, owner;    /* its triangles; whose the first of them is */
    double length;        /* m: as x had it */
};

/* Demands that normal . sum of weight x is at least `want`. */
enum { UNTANGLE_CORNERS = 5 };
struct untangle_push {
    uint32_t n, point[UNTANGLE_CORNERS];
    uint32_t still; /* bit k: corner k moves only if no other can */
    double weight[UNTANGLE_CORNERS], want;
    phys_vec normal;
};

/* An edge that goes through a triangle. */
struct untangle_crossing {
    uint32_t edge, triangle;
};

struct untangle_body {
    const struct contact_body *body; /* NULL: the obstacle is none */
    struct contact_pose pose;
    struct contact_surface first; /* its first point and triangle */
    struct contact_skin skin;
    void *boxes;
};

/* clang-format off */
/* The arrays: type, name, numbers of an item, items: p points, t triangles. */
#define UNTANGLE_ARRAYS(X)                                                                         \
    X(phys_vec, x, , p)                                                                            \
    X(phys_vec, start, , p)                                                                        \
    X(phys_vec, best, , p)           /* of the round with the least wrong */                       \
    X(phys_vec, normal, , p)         /* as long as areas are */                                    \
    X(double, place, [3], p)         /* the same as x, for verify */                               \
    X(uint32_t, corner, [3], t)                                                                    \
    X(uint32_t, side, [3], t)        /* its edges */                                               \
    X(uint32_t, owner, , t)          /* a cloth, or n_cloths + an obstacle */                      \
    X(uint32_t, cloth, , p)          /* a cloth that has it, or the same of a body */              \
    X(struct untangle_edge, edge, , 3 * t)                                                         \
    X(unsigned char, held, , p)                                                                    \
    X(unsigned char, border, , p)    /* a surface ends there, or goes on as another */             \
    X(unsigned char, used, , p)      /* a triangle of cloth has it */                              \
    X(unsigned char, shared, , p)    /* of two cloths */                                           \
    X(unsigned char, moved, , p)     /* so far */                                                  \
    X(uint32_t, piece, , p)          /* the root of its piece: all that edges join */              \
    /* used within a round */                                                                      \
    X(uint32_t, part, , p)           /* the root of its part */                                    \
    X(uint32_t, size, , p)           /* vertices of a part */                                      \
    X(uint32_t, largest, , p)        /* of a piece: a point of its largest part */                 \
    X(unsigned char, cut, , 3 * t)   /* by edge: 0 between rounds */                               \
    X(uint32_t, zone, , p)           /* the root of its zone; */                                   \
    X(uint32_t, votes, [2], p)       /* of it, for either side */                                  \
    X(signed char, label, , p)       /* side of a cloth, 1 or -1; 0: none */                       \
    X(uint32_t, sides, [2], p)       /* by piece: points of outer cloths on its outer side, */     \
    X(uint32_t, outer, , p)          /* on its inner side; a cloth of those */                     \
    X(uint32_t, stamp, , t)          /* a part that crosses it */                                  \
    X(unsigned char, wrong, , p)     /* of a part on the wrong side */                             \
    X(unsigned char, tangled, , p)   /* of a crossing within its own layer */                      \
    X(unsigned char, inside, , p)    /* too deep in an obstacle */                                 \
    X(unsigned char, seen, , p)      /* already looked at */
/* clang-format on */

struct untangle {
    const struct untangle_cloths *of;
    uint32_t n_cloths, n_obstacles;
    uint32_t n_cloth_points, n_cloth_triangles; /* the first ones of: */
    uint32_t n_points, n_triangles, n_edges;
#define UNTANGLE_MEMBER(type, name, numbers, items) type(*name) numbers;
    UNTANGLE_ARRAYS(UNTANGLE_MEMBER)
    struct untangle_body *body; /* by obstacle */
    uint32_t *joined;           /* by point of all: as of contact_apart; NULL: none is */
    struct contact_skin skin;   /* of all cloths */
    void *boxes;
    struct contact_facet *facet; /* of the tree of all cloths */
    struct contact_node *node;
    uint32_t n_nodes;
    double open, room; /* m: no pair may be nearer; the distance to which pushes move */
    struct cloth_list pairs, crossings, links, zoned, pushes; /* of a round */
    struct untangle_count count;
    uint32_t near[4]; /* as of untangle_result */

    struct cloth_pool memory; /* of all above but lists */
    struct cloth_error *error;
};

int untangle_open(struct untangle *all, phys_vec *x);
void untangle_close(struct untangle *all);
/* Boxes, normals and the tree follow the points. */
void untangle_refit(struct untangle *all);

/* Finds the pieces of cloth. */
void untangle_pieces(struct untangle *all);
/* Names parts of inner cloths that face away from outer ones, in the round that untangle_layers
 * looked at. */
void untangle_turned(const struct untangle *all, struct untangle_result *result);

/* Each finds one kind of fault in a round, counts it and adds pushes. */
int untangle_cross(struct untangle *all);     /* first: fills crossings */
int untangle_parts(struct untangle *all);     /* after it: parts, and pushes of the wrong ones */
int untangle_zones(struct untangle *all);     /* in it: of pairs of cloths that are not cut off */
int untangle_shorten(struct untangle *all);   /* after these: shorter contours */
int untangle_layers(struct untangle *all);    /* after untangle_cross */
int untangle_obstacles(struct untangle *all); /* before untangle_shorten */
int untangle_near(struct untangle *all);      /* last */

/* The nearest point of the cloths' triangles that `allows` takes, nearer than reach. */
struct untangle_nearest {
    uint32_t triangle;
    struct contact_nearest at; /* corner 0 is the point, the others those of the triangle */
};
typedef bool untangle_allows(const struct untangle *all, uint32_t triangle, const void *context);
bool untangle_find(const struct untangle *all, const phys_vec *x, double reach,
                   untangle_allows *allows, const void *context, struct untangle_nearest *found);

/* The nearest point of a cloth to a point, nearer than the reach, and the unit normal there. False:
 * there is none, or it is at the border, where the point is on no side. */
#define UNTANGLE_REACH 30 /* thicknesses: a point farther away is not beside that cloth */
bool untangle_beside(const struct untangle *all, uint32_t point, uint32_t cloth,
                     struct untangle_nearest *at, phys_vec *normal);

/* Each pushes something to the side of a cloth where `normal` points, or the cloth's own normal
 * times `sign`: a vertex; the end of a crossing edge that is on the wrong side; a triangle that an
 * edge of the cloth crosses. still: the cloth stays. */
int untangle_push_vertex(struct untangle *all, uint32_t point, const struct untangle_nearest *at,
                         const phys_vec *normal, bool still);
int untangle_push_edge(struct untangle *all, const struct untangle_crossing *crossing, double sign,
                       bool still);
int untangle_push_triangle(struct untangle *all, const struct untangle_crossing *crossing,
                           double sign, bool still);

/* The place of a crossing: weights of the edge's ends, then of the triangle's corners; each sum is
 * 1. */
void untangle_place(const struct untangle *all, const struct untangle_crossing *crossing,
                    double weight[UNTANGLE_CORNERS]);

/* Adds a push. Error: CLOTH_E_MEMORY. */
int untangle_add(struct untangle *all, const struct untangle_push *push);
/* Moves x. */
void untangle_move(struct untangle *all);

/* True if two surfaces, owners of triangles, meet. */
static inline bool untangle_meets(const struct untangle *all, uint32_t a, uint32_t b)
{
    const uint32_t n = all->n_cloths, cloth = a < n ? a : b, other = a < n ? b : a;
    return cloth < n && !(all->of->self_off && a == b) &&
           !(all->of->apart && contact_are_apart(all->of->apart, cloth, other));
}

/* True if a pin that follows the obstacle `owner` holds one of the n points of a feature. Points of
 * bodies are never pinned. */
static inline bool untangle_attached(const struct untangle *all, uint32_t n, const uint32_t *point,
                                     uint32_t owner)
{
    const uint32_t cloths = all->n_cloths;
    bool is = false;
    for (uint32_t k = 0; k < n && all->of->apart && owner >= cloths; k++)
        is = is || (point[k] < all->n_cloth_points &&
                    contact_is_attached(all->of->apart, 1, point + k, owner - cloths));
    return is;
}

/* True if two surfaces, owners of triangles, are cloths of different layers. */
static inline bool untangle_layered(const struct untangle *all, uint32_t a, uint32_t b)
{
    const uint32_t n = all->n_cloths;
    return a < n && b < n && all->of->layer[a] != all->of->layer[b];
}

/* True if untangle_zones treats this pair of cloths. */
bool untangle_zoned(const struct untangle *all, uint32_t a, uint32_t b);

/* Scales it to length 1; false if it has no length. */
PHYS_INLINE bool untangle_unit(phys_vec *a)
{
    const double length = sqrt(phys_dot(a, a));
    if (!(length > CONTACT_TINY))
        return false;
    *a /= length;
    return true;
}

/* The unit normal of a triangle, or 0 if it has no area. */
PHYS_INLINE void untangle_face(const struct untangle *all, uint32_t triangle, phys_vec *normal)
{
    const uint32_t *c = all->corner[triangle];
    const phys_vec u = all->x[c[1]] - all->x[c[0]], v = all->x[c[2]] - all->x[c[0]];
    phys_cross(&u, &v, normal);
    if (!untangle_unit(normal))
        *normal = (phys_vec){0};
}

#endif
