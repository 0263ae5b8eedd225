#ifndef CLOTH_CONTACT_BODY_SKIN_H
#define CLOTH_CONTACT_BODY_SKIN_H

#include "cloth/contact/shape.h"
#include "cloth/contact/skin.h"

/* A body as a skin, as blocks of cloth are. Points are the body's vertices; features are all of its
 * triangles, edges and vertices. Over a step each point moves straight between its places at both
 * ends, by the pose or by the frames, so a motion has no jump from step to step. No way can be cut.
 * The certificates of cloth hold for it as they are. Local. */

/* Room for its table, and for boxes of a step, in bytes, aligned to CONTACT_ALIGN. */
size_t contact_body_skin_bytes(const struct contact_body *body);
size_t contact_body_boxes_bytes(const struct contact_body *body);

/* Makes the table, once for all steps: writes every byte of that room. Vertex v has the id
 * first_id + v. No vertex of a cloth, nor one of another body, may have such an id: pairs that
 * share one are left out. Error: CLOTH_E_MEMORY. */
int contact_body_skin_make(const struct contact_body *body, uint32_t first_id, void *table,
                           struct cloth_error *error);

/* Fills x and y (m), by vertex, at the begin and at the end of a step. way: that of the body's
 * middle; contact_refit makes small boxes in its frame. They are the same in every step for a body
 * that stands still. */
void contact_body_ends(const struct contact_body *body, const struct contact_pose *pose,
                       phys_vec *x, phys_vec *y, phys_vec *way);

/* x and y of one vertex. */
void contact_body_vertex_ends(const struct contact_body *body, const struct contact_pose *pose,
                              uint32_t vertex, phys_vec *x, phys_vec *y);

/* Fills, by vertex, a facet that has it; UINT32_MAX: none has. */
void contact_body_fans(const struct contact_body *body, uint32_t *fan);

/* True if the unit direction n is in the cone that the surface leaves open at a point: then points
 * along n have it as their nearest point nearby. The point lies between n_vertices vertices: on
 * one, on an edge or in a facet. y: by vertex, m. At edges within a flat part, only the normal is
 * in the cone; at an edge that goes in, no direction is. So a contact beside an edge does not stop
 * motion across it. */
bool contact_body_opens(const struct contact_body *body, const uint32_t *fan, const phys_vec *y,
                        uint32_t n_vertices, const uint32_t *vertex, const phys_vec *point,
                        const phys_vec *n);

/* True if the surface bends at a vertex or an edge, by more than 0.1 degree. */
bool contact_body_bends(const struct contact_body *body, const uint32_t *fan, const phys_vec *y,
                        uint32_t n_vertices, const uint32_t *vertex);

#endif
