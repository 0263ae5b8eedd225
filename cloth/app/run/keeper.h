#ifndef CLOTH_APP_RUN_KEEPER_H
#define CLOTH_APP_RUN_KEEPER_H

#include "cloth/base/error.h"
#include "cloth/output/checkpoint.h"
#include "cloth/output/settle.h"

/* Writes checkpoints while the run goes on: a thread of its own, on rank 0 alone. One is written at
 * a time. One that fails is said once, and the run goes on. */
struct keeper;

/* seconds: between the begins of two. settings: the first part of each; settler: of the frames of
 * the folder. Both outlive the keeper. Before the runtime binds its threads to cores. Errors: of
 * output_checkpoints_open; CLOTH_E_LIBRARY, no thread. */
int keeper_open(struct keeper **keeper, const char *folder, double seconds, const char *settings,
                struct output_settler *settler, struct cloth_error *error);

/* Nonzero once when a checkpoint is due; then 0 until keeper_take and the next time. From any
 * thread. */
int keeper_due(struct keeper *keeper);

/* Has one written: of the program and of the flow. Their memory is the keeper's from then on; NULL:
 * there was none for it. Waits for one that is being written. From one thread at a time. */
void keeper_take(struct keeper *keeper, struct output_part program, struct output_part flow);

/* Waits until the taken parts are on the disk; *keeper becomes NULL. */
void keeper_close(struct keeper **keeper);

#endif
