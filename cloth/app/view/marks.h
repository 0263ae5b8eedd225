#ifndef CLOTH_APP_VIEW_MARKS_H
#define CLOTH_APP_VIEW_MARKS_H

#include "cloth/mesh/mesh.h"
#include "cloth/model/model.h"

/* Marks of a scene that has not run, as meshes: a stud on each vertex that a pin holds or moves,
 * but for cloths that are pinned all over; lines along both sides of each seam, and from partner to
 * partner. Local. */
enum { VIEW_MARK_PINS, VIEW_MARK_SEAMS, VIEW_MARKS };
extern const char *const view_marks_names[VIEW_MARKS];
struct view_marks {
    struct mesh mesh[VIEW_MARKS];
};

/* at: where each vertex of all cloths starts, m, as model_cloth.start has it; held: 1 of those that
 * are pinned. To be freed in any case. Error: CLOTH_E_MEMORY. */
int view_marks_make(struct view_marks *marks, const struct model *model, const double (*at)[6],
                    const unsigned char *held, struct cloth_error *error);
uint32_t view_marks_vertices(const struct view_marks *marks);
/* Their places, m: 3 numbers a vertex. */
void view_marks_place(const struct view_marks *marks, double *position);
void view_marks_free(struct view_marks *marks);

#endif
