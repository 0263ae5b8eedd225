#ifndef CLOTH_OUTPUT_OUTPUT_H
#define CLOTH_OUTPUT_OUTPUT_H

#include "cloth/base/error.h"
#include "cloth/contact/apart.h"
#include "cloth/contact/shape.h"
#include "cloth/mesh/mesh.h"
#include "cloth/output/settle.h"
#include "cloth/solve/system.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Frames on disk, on rank 0 only. A folder holds
 *   cloth.obj      the start, with the input's polygons, one `o` per cloth
 *   cloth.pc2      PC2 point cache: header, then one float x y z a vertex and frame
 *   frames.csv     frame,time: the true time of each frame
 *   contact.pc2    if asked for: the force of contact on each vertex (output_forces)
 *   colours.bin    data to colour by: blocks, ranks, shapes at rest (colours.h)
 *   body-K.obj     the bodies among the obstacles, K from 0, without their motion
 *   body-K.pc2     the shapes of bodies that change them: a PC2 point cache, frame by frame
 *   scene.json     {"fps", "obstacles": [{KIND: {its parameters}}]}
 *
 * A body in scene.json is {"obj": its file}, with "pc2" if it changes its shape. An obstacle that
 * moves has "about" and "keys": [{"time", "translate", "rotate"}]. Further keys:
 *   "apart"        of several cloths, or where the scene keeps some from meeting: {"cloths":
 *                  [vertices of each], "pairs": [[cloth, other], ...]}; numbers of obstacles
 *                  follow those of cloths
 *   "attached"     where pins follow obstacles: [[obstacle, vertex, ...], ...]: vertices whose
 *                  triangles do not meet it
 *   "sewn"         where seams are pulled: [[a, b], ...]: vertices whose triangles do not meet
 *
 * PC2's count of frames is rewritten and synced once their bytes are on the disk, so a killed run
 * leaves whole files up to the last finished frame. */
struct output_frames;

struct output_setup {
    const char *folder; /* made if missing */
    size_t n_meshes;
    const struct mesh *const
        *meshes;              /* input meshes at their start; read during output_open only */
    const char *const *names; /* n_meshes */
    double fps;
    size_t n_obstacles;
    const struct contact_shape *obstacles;
    const struct phys_key *keys;         /* of their motions */
    const struct contact_bodies *bodies; /* that they name; NULL: none */
    const bool *posed;                   /* of each of them: it changes its shape in some frame;
                                          * NULL: none does */
    const struct contact_apart *apart;   /* pairs that do not meet; NULL: all meet */
    size_t n_inputs;
    const char *const *inputs; /* paths that the run reads, which are not replaced */
    const uint64_t *n_frames; /* how many of an earlier run stay, whose files go on; NULL: none, and
                               * the files are new */
    struct output_settler *settler; /* brings frames to the disk; NULL: the writer does */
};

/* Opens a folder for frames. Files of an earlier run in it are replaced. A cloth.obj or body-K.obj
 * of anyone else is not, nor an input: CLOTH_E_INPUT, before anything changes. Further errors:
 * CLOTH_E_INPUT where the folder cannot be written to, or has fewer frames than are to stay;
 * CLOTH_E_IO, CLOTH_E_MEMORY. */
int output_open(struct output_frames **frames, const struct output_setup *setup,
                struct cloth_error *error);

/* Writes scene.json again for a setup with other motions. Parts of the setup that other files hold
 * are not read. Errors as of output_open. */
int output_scene(const struct output_frames *frames, const struct output_setup *setup,
                 struct cloth_error *error);

/* Writes the text of scene.json for a setup. Failures are the file's. */
void output_scene_text(FILE *file, const struct output_setup *setup);

/* Bytes of the files that output_open makes for a setup, about, and of what each frame adds to
 * them. Touches no file. Local. */
double output_begin_bytes(const struct output_setup *setup, double *frame);

/* Bytes free for files in a folder, which need not exist yet, plus those of the earlier run's files
 * that would be replaced. Infinite if the file system does not say. Local. */
double output_room(const char *folder);

/* Takes these bodies, of the same meshes, from now on; their time 0 is the frames' time `begin`, s.
 */
void output_bodies_go_on(struct output_frames *frames, const struct contact_bodies *bodies,
                         double begin);

/* Appends a frame: position is (all vertices) x 3, metres. Has the form of flow_output.frame,
 * context = frames. A frame that fails leaves the ones before it whole. With a settler the failure
 * may be that of an earlier frame. */
int output_frame(void *context, uint64_t frame, double time, const double *position,
                 struct cloth_error *error);

/* Number of frames counted, on the disk. From any thread. */
uint64_t output_frames_settled(const struct output_frames *frames);

/* Closes, when the settler is closed; *frames becomes NULL. */
int output_close(struct output_frames **frames, struct cloth_error *error);

/* The force of contact on each vertex in each frame, DIR/contact.pc2: a PC2 cache like cloth.pc2,
 * with forces, N, in the place of positions. It may have fewer frames, of a run that goes on or was
 * killed. Local functions, on rank 0. */
struct output_forces;

/* Begins it in a folder of frames, which is there. Replaces the one of an earlier run, nothing
 * else, or goes on with its first frames (n_frames and settler as of struct output_setup). Errors
 * as of output_open. */
int output_forces_open(struct output_forces **forces, const char *folder, uint32_t n_vertices,
                       const uint64_t *n_frames, struct output_settler *settler,
                       struct cloth_error *error);

/* Appends a frame: force is (all vertices) x 3. Has the form of flow_output.force, context =
 * forces. A frame that fails leaves the ones before it whole. */
int output_forces_frame(void *context, uint64_t frame, const double *force,
                        struct cloth_error *error);

/* Closes; *forces becomes NULL. */
int output_forces_close(struct output_forces **forces, struct cloth_error *error);

/* Removes that of an earlier run from a folder of frames, whose run has none. */
int output_forces_forget(const char *folder, struct cloth_error *error);

/* Counts its frames, and reads one back, unless force is NULL or that frame is not there (yet).
 * Errors: CLOTH_E_INPUT, there is no such file, or it cannot be read. */
int output_forces_read(const char *folder, uint32_t n_vertices, uint64_t frame, double *force,
                       uint64_t *n_frames, struct cloth_error *error);

/* A folder's lock: DIR/duite.lock, which names the host and the process of the run that writes into
 * the folder, and since when that runs. Local functions, on rank 0. */
struct output_lock;

/* Takes the lock before anything else in the folder changes; the folder is made if missing. A lock
 * of a process of this host that runs no more is replaced; then `note` says so (CLOTH_E_IO). One
 * process may take a folder twice. SIGTERM, SIGINT and SIGHUP remove the locks, from the first one
 * on, before they end the process. Errors: CLOTH_E_INPUT where another run has the folder, which
 * the lock and the message name; else as of output_open. */
int output_lock_take(struct output_lock **lock, const char *folder, struct cloth_error *note,
                     struct cloth_error *error);

/* Removes it, if it is still that of this process; *lock becomes NULL. */
void output_lock_free(struct output_lock **lock);

/* Removes the locks of a process that ends without more. From any thread, and a signal handler. */
void output_locks_remove(void);

/* The table of probes, DIR/probes.csv: a header, then a row a step, written when the step is done:
 * a run that is killed leaves the rows so far. Local functions, on rank 0. */
struct output_probes;

/* Begins the table; header: its columns' names with commas between, the first two `step` and `time
 * [s]`. Replaces the table of an earlier run, nothing else, or goes on behind its first *n_rows
 * rows; NULL: a new table. Errors as of output_open. */
int output_probes_open(struct output_probes **probes, const char *folder, const char *header,
                       const uint64_t *n_rows, struct cloth_error *error);

/* Appends a row. Has the form of flow_output.row, context = probes. Numbers have 17 digits; numbers
 * that are not finite are left out. A row that fails leaves the ones before it whole. */
int output_probes_row(void *context, uint64_t step, double time, size_t n, const double *values,
                      struct cloth_error *error);

/* Syncs the table of a folder to the disk, if there is one, whichever process writes it. Error:
 * CLOTH_E_IO. */
int output_probes_sync(const char *folder, struct cloth_error *error);

/* Closes, with all rows on the disk; *probes becomes NULL. */
int output_probes_close(struct output_probes **probes, struct cloth_error *error);

/* Removes the table of an earlier run from a folder of frames, whose run has none. */
int output_probes_forget(const char *folder, struct cloth_error *error);

/* Reads a folder back (viewer, tests). */
struct output_cache {
    struct mesh mesh; /* of cloth.obj */
    uint64_t n_frames;
    double *time; /* n_frames, s */
    double fps;
    uint32_t n_obstacles, n_keys;
    struct contact_shape *obstacles;
    struct phys_key *keys; /* of their motions */
    uint32_t n_bodies;
    struct contact_bodies bodies; /* n_bodies */
    bool *posed;                  /* n_bodies: those that change their shape; NULL: none is there */
    FILE **poses;                 /* n_bodies: of these, their shapes */
    struct contact_apart apart;   /* pairs that do not meet */
    uint32_t *attached;           /* n_vertices; as apart.attached, which it is */
    FILE *pc2;
    double *held; /* n_vertices x 3: the only frame of a cache in memory, which has no files; NULL:
                   * it is of a folder */
};
int output_cache_open(struct output_cache *cache, const char *folder, struct cloth_error *error);
/* Reads the text of a scene.json, ended by '\0', into a cache that has its mesh; `name` begins its
 * errors. The cache owns its memory, also after an error: CLOTH_E_INPUT. */
int output_cache_scene(struct output_cache *cache, const char *text, const char *name,
                       struct cloth_error *error);
/* Reads one frame: n_vertices x 3 doubles into position. */
int output_cache_frame(struct output_cache *cache, uint64_t frame, double *position,
                       struct cloth_error *error);
/* Gives the bodies that change their shape the one of a frame. */
int output_cache_pose(struct output_cache *cache, uint64_t frame, struct cloth_error *error);
void output_cache_close(struct output_cache *cache);

/* Writes a mesh as a Wavefront OBJ of one object, v in metres, with 17 digits. An old file of that
 * name is replaced when the new one is whole. Errors: CLOTH_E_INPUT where it cannot be written to,
 * CLOTH_E_IO, CLOTH_E_MEMORY. Local. */
int output_mesh_obj(const char *path, const struct mesh *mesh, const char *name,
                    struct cloth_error *error);

/* Writes a system for other solvers, in Matrix Market form (Boisvert, Pozo & Remington 1996), into
 * an existing folder (output_lock_take). matrix.mtx is S A S + I - S: symmetric, its lower
 * triangle, column by column, one entry a place. The others are arrays: rhs.mtx (S b), solution.mtx
 * (dv), mass.mtx (of each unknown; 0 where held), position.mtx (after the step). Unknown 3 i + c is
 * component c of vertex i, both from 0. Files of these names are replaced. Errors as of
 * output_open. Local. */
int output_system(const char *folder, const struct solve_system *system, struct cloth_error *error);

/* A JSON object, written whole or not at all (a temporary name, then renamed). Keys in the
 * order they are added; NaN and infinities become null. It is flat but for lists of flat objects.
 */
struct output_report;
/* Checks, without writing, that a report can be written to the path. made: a folder that will be
 * there by then, or NULL. CLOTH_E_INPUT names the fault, not the path. */
int output_report_check(const char *path, const char *made, struct cloth_error *error);
int output_report_new(struct output_report **report, struct cloth_error *error);
void output_report_text(struct output_report *report, const char *key, const char *value);
void output_report_number(struct output_report *report, const char *key, double value);
void output_report_integer(struct output_report *report, const char *key, uint64_t value);
void output_report_null(struct output_report *report, const char *key);
/* Begins a list, to which each call of output_report_item begins an object: the keys that follow
 * are of this, until the list is ended. */
void output_report_list(struct output_report *report, const char *key);
void output_report_item(struct output_report *report);
void output_report_list_end(struct output_report *report);
/* Writes the report to the file that the path names, or leads to through links. Errors as of
 * output_open. */
int output_report_write(struct output_report *report, const char *path, struct cloth_error *error);
void output_report_free(struct output_report *report);

#endif
