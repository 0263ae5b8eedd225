/* OTF2, the Open Trace Format 2 of Score-P's tools, which Vampir opens: a location for each worker
 * in a group for each rank, a region for each kernel and each state, messages between ranks. The
 * times of a location rise, so its events are its moments; steals and other marks are left out.
 * Definitions follow the events, since they say how many there are. */
#include "config.h"

#include "tools/trace/export.h"

#include "runtime/base/error.h"

#ifdef HAVE_OTF2
#include "runtime/base/memory.h"
#include "runtime/task/task.h"

#include <math.h>
#include <otf2/otf2.h>
#include <stdio.h>
#include <stdlib.h>

enum { CHUNK_EVENTS = 1 << 18, CHUNK_DEFINITIONS = 1 << 22 }; /* bytes that are kept in memory */
enum { OWN_KINDS = 64, REGIONS_BESIDE = OWN_KINDS + TRACE_KINDS }; /* regions that are no kernel */
enum { COMM_LOCATIONS, COMM_RANKS, COMM = 0 };                     /* groups; the communicator */
static const uint64_t TICKS = 1000000000;                          /* of a second */

struct otf2_region {
    const char *name;
    bool task;
};

struct otf2_writer {
    const struct trace_run *run;
    const struct trace_spans *spans;
    OTF2_Archive *archive;
    OTF2_GlobalDefWriter *defs;
    uint32_t *number;           /* by slot of a kernel or state: that of its region, from 1; or 0 */
    struct otf2_region *region; /* as they come: readers warn of gaps between numbers */
    uint64_t *n_events;         /* by worker */
    uint64_t last;              /* ns */
    uint32_t n_regions, n_strings;
    OTF2_ErrorCode code; /* of the first failure */
};

static OTF2_FlushType otf2_flush(void *data, OTF2_FileType type, OTF2_LocationRef location,
                                 void *caller, bool final)
{
    (void)data, (void)type, (void)location, (void)caller, (void) final;
    return OTF2_FLUSH;
}

/* The sentence is ours. */
static OTF2_ErrorCode otf2_keep_quiet(void *data, const char *file, uint64_t line,
                                      const char *function, OTF2_ErrorCode code, const char *format,
                                      va_list values)
{
    (void)data, (void)file, (void)line, (void)function, (void)format, (void)values;
    return code;
}

static void otf2_note(struct otf2_writer *w, OTF2_ErrorCode code)
{
    if (!w->code)
        w->code = code;
}

/* ---- Events ---- */

static uint32_t otf2_slot(const struct otf2_writer *w, const struct trace_event *event)
{
    const uint32_t n = w->run->n_kernels;
    if (event->kind == TRACE_TASK)
        return event->kernel;
    if (event->kind == TRACE_OWN)
        return n + (event->kernel < OWN_KINDS ? event->kernel : OWN_KINDS - 1);
    return n + OWN_KINDS + event->kind;
}

static uint32_t otf2_number(struct otf2_writer *w, const struct trace_span *span)
{
    uint32_t *number = &w->number[otf2_slot(w, span->event)];
    if (!*number) {
        w->region[w->n_regions] = (struct otf2_region){span->name, span->event->kind == TRACE_TASK};
        *number = ++w->n_regions;
    }
    return *number - 1;
}

static void otf2_put_moment(struct otf2_writer *w, OTF2_EvtWriter *events,
                            const struct trace_moment *m)
{
    const uint64_t time = m->time > 0 ? (uint64_t)llrint((double)TICKS * m->time) : 0;
    w->last = time > w->last ? time : w->last;
    switch (m->what) {
    case MOMENT_BEGIN:
        otf2_note(w, OTF2_EvtWriter_Enter(events, NULL, time, otf2_number(w, m->span)));
        break;
    case MOMENT_END:
        otf2_note(w, OTF2_EvtWriter_Leave(events, NULL, time, otf2_number(w, m->span)));
        break;
    case MOMENT_SENT:
        otf2_note(w, OTF2_EvtWriter_MpiSend(events, NULL, time, m->message->to_rank, COMM, 0,
                                            m->message->bytes));
        break;
    case MOMENT_RECEIVED:
        otf2_note(w, OTF2_EvtWriter_MpiRecv(events, NULL, time, m->message->from_rank, COMM, 0,
                                            m->message->bytes));
        break;
    default:
        break;
    }
}

static int otf2_by_worker(const void *a, const void *b)
{
    const struct trace_moment *x = a, *y = b;
    return x->worker != y->worker ? (x->worker > y->worker) - (x->worker < y->worker)
                                  : trace_moment_compare(a, b);
}

/* One location after the other, so that one is in memory. */
static void otf2_put_events(struct otf2_writer *w, struct trace_moment *moment, size_t n)
{
    qsort(moment, n, sizeof *moment, otf2_by_worker);
    otf2_note(w, OTF2_Archive_OpenEvtFiles(w->archive));
    for (uint32_t worker = 0; worker < w->spans->n_workers && !w->code; worker++) {
        OTF2_EvtWriter *events = OTF2_Archive_GetEvtWriter(w->archive, worker);
        if (!events) {
            otf2_note(w, OTF2_ERROR_FILE_CAN_NOT_OPEN);
            return;
        }
        for (; n && moment->worker == worker; n--)
            otf2_put_moment(w, events, moment++);
        otf2_note(w, OTF2_EvtWriter_GetNumberOfEvents(events, &w->n_events[worker]));
        otf2_note(w, OTF2_Archive_CloseEvtWriter(w->archive, events));
    }
    otf2_note(w, OTF2_Archive_CloseEvtFiles(w->archive));
}

/* Readers expect a file of definitions for each location, though all are global. */
static void otf2_put_local_files(struct otf2_writer *w)
{
    otf2_note(w, OTF2_Archive_OpenDefFiles(w->archive));
    for (uint32_t worker = 0; worker < w->spans->n_workers && !w->code; worker++) {
        OTF2_DefWriter *local = OTF2_Archive_GetDefWriter(w->archive, worker);
        otf2_note(w, local ? OTF2_Archive_CloseDefWriter(w->archive, local)
                           : OTF2_ERROR_FILE_CAN_NOT_OPEN);
    }
    otf2_note(w, OTF2_Archive_CloseDefFiles(w->archive));
}

/* ---- Definitions ---- */

static uint32_t otf2_string(struct otf2_writer *w, const char *text)
{
    otf2_note(w, OTF2_GlobalDefWriter_WriteString(w->defs, w->n_strings, text));
    return w->n_strings++;
}

static void otf2_put_regions(struct otf2_writer *w, uint32_t none)
{
    for (uint32_t r = 0; r < w->n_regions && !w->code; r++) {
        const uint32_t name = otf2_string(w, w->region[r].name);
        otf2_note(w, OTF2_GlobalDefWriter_WriteRegion(
                         w->defs, r, name, name, none,
                         w->region[r].task ? OTF2_REGION_ROLE_TASK : OTF2_REGION_ROLE_ARTIFICIAL,
                         OTF2_PARADIGM_USER, OTF2_REGION_FLAG_NONE, none, 0, 0));
    }
}

static void otf2_put_locations(struct otf2_writer *w)
{
    const uint32_t run = otf2_string(w, "run"), class = otf2_string(w, "machine");
    char name[64];
    otf2_note(w, OTF2_GlobalDefWriter_WriteSystemTreeNode(w->defs, 0, run, class,
                                                          OTF2_UNDEFINED_SYSTEM_TREE_NODE));
    for (uint32_t i = 0, rank = 0; i < w->spans->n_workers && !w->code; i++) {
        const bool first = !i || w->spans->host_of[i - 1] != w->spans->host_of[i];
        rank = w->spans->host_of[i];
        if (first) {
            snprintf(name, sizeof name, "rank %u", rank);
            otf2_note(w, OTF2_GlobalDefWriter_WriteLocationGroup(
                             w->defs, rank, otf2_string(w, name), OTF2_LOCATION_GROUP_TYPE_PROCESS,
                             0, OTF2_UNDEFINED_LOCATION_GROUP));
        }
        snprintf(name, sizeof name, "rank %u worker %u", rank,
                 i - trace_first_worker(w->run, rank));
        otf2_note(w, OTF2_GlobalDefWriter_WriteLocation(w->defs, i, otf2_string(w, name),
                                                        OTF2_LOCATION_TYPE_CPU_THREAD,
                                                        w->n_events[i], rank));
    }
}

/* All ranks; a rank's place among them is that of its first worker in the list of locations. */
static void otf2_put_communicator(struct otf2_writer *w, uint32_t none)
{
    const uint32_t n = w->run->n_ranks;
    uint64_t *member = base_alloc(2 * n * sizeof *member);
    if (!member) {
        otf2_note(w, OTF2_ERROR_MEM_ALLOC_FAILED);
        return;
    }
    for (uint32_t r = 0; r < n; r++) {
        member[r] = trace_first_worker(w->run, r);
        member[n + r] = r;
    }
    otf2_note(w, OTF2_GlobalDefWriter_WriteGroup(w->defs, COMM_LOCATIONS, none,
                                                 OTF2_GROUP_TYPE_COMM_LOCATIONS, OTF2_PARADIGM_MPI,
                                                 OTF2_GROUP_FLAG_NONE, n, member));
    otf2_note(w, OTF2_GlobalDefWriter_WriteGroup(w->defs, COMM_RANKS, none,
                                                 OTF2_GROUP_TYPE_COMM_GROUP, OTF2_PARADIGM_MPI,
                                                 OTF2_GROUP_FLAG_NONE, n, member + n));
    otf2_note(w, OTF2_GlobalDefWriter_WriteComm(w->defs, COMM, otf2_string(w, "ranks"), COMM_RANKS,
                                                OTF2_UNDEFINED_COMM, OTF2_COMM_FLAG_NONE));
    base_free(member);
}

static void otf2_put_definitions(struct otf2_writer *w)
{
    w->defs = OTF2_Archive_GetGlobalDefWriter(w->archive);
    if (!w->defs) {
        otf2_note(w, OTF2_ERROR_FILE_CAN_NOT_OPEN);
        return;
    }
    otf2_note(w,
              OTF2_GlobalDefWriter_WriteClockProperties(
                  w->defs, TICKS, 0, w->last + 1, (uint64_t)w->run->rank[0].header->began * TICKS));
    const uint32_t none = otf2_string(w, "");
    otf2_put_regions(w, none);
    otf2_put_locations(w);
    if (w->run->n_ranks > 1)
        otf2_put_communicator(w, none);
}

/* ---- The archive ---- */

static void otf2_put_all(struct otf2_writer *w, const char *folder, struct trace_moment *moment,
                         size_t n)
{
    static const OTF2_FlushCallbacks flush = {.otf2_pre_flush = otf2_flush};
    OTF2_Error_RegisterCallback(otf2_keep_quiet, NULL);
    w->archive = OTF2_Archive_Open(folder, "traces", OTF2_FILEMODE_WRITE, CHUNK_EVENTS,
                                   CHUNK_DEFINITIONS, OTF2_SUBSTRATE_POSIX, OTF2_COMPRESSION_NONE);
    if (!w->archive) {
        otf2_note(w, OTF2_ERROR_FILE_CAN_NOT_OPEN);
        return;
    }
    otf2_note(w, OTF2_Archive_SetFlushCallbacks(w->archive, &flush, NULL));
    otf2_note(w, OTF2_Archive_SetSerialCollectiveCallbacks(w->archive));
    if (!w->code)
        otf2_put_events(w, moment, n);
    if (!w->code)
        otf2_put_local_files(w);
    if (!w->code)
        otf2_put_definitions(w);
    otf2_note(w, OTF2_Archive_Close(w->archive));
}

static int otf2_write(const struct trace_run *run, const char *folder)
{
    struct trace_spans spans;
    struct trace_messages messages = {0};
    struct trace_moment *moment = NULL;
    struct otf2_writer w = {.run = run, .spans = &spans};
    size_t n = 0;
    int code = trace_spans_find(run, &spans);
    if (!code)
        code = trace_messages_find(run, &messages);
    if (!code)
        code = trace_moments_find(&spans, &messages, &moment, &n);
    w.number = base_alloc_zero((run->n_kernels + REGIONS_BESIDE) * sizeof *w.number);
    w.region = base_alloc_zero((run->n_kernels + REGIONS_BESIDE) * sizeof *w.region);
    w.n_events = base_alloc_zero((spans.n_workers + 1) * sizeof *w.n_events);
    if (!code && (!w.number || !w.region || !w.n_events))
        code = base_no_memory("an OTF2 archive");
    if (!code)
        otf2_put_all(&w, folder, moment, n);
    if (w.code)
        code = base_error(DUITE_E_SYSTEM,
                          "the OTF2 archive %s cannot be written (a folder that has one already is "
                          "refused): %s",
                          folder, OTF2_Error_GetDescription(w.code));
    base_free(w.number);
    base_free(w.region);
    base_free(w.n_events);
    base_free(moment);
    base_free(messages.message);
    trace_spans_free(&spans);
    return code;
}

#else

static int otf2_write(const struct trace_run *run, const char *folder)
{
    (void)run, (void)folder;
    return base_error(DUITE_E_SYSTEM, "this duite-trace was built without OTF2: install "
                                      "libopen-trace-format2-dev and configure it again");
}

#endif

const struct trace_export trace_export_otf2 = {
    .option = "otf2",
    .help = "write an OTF2 archive, which Vampir and Score-P's tools open",
    .write_folder = otf2_write,
};
