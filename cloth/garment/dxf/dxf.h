#ifndef CLOTH_GARMENT_DXF_DXF_H
#define CLOTH_GARMENT_DXF_DXF_H

#include "cloth/base/memory.h"
#include "cloth/garment/pattern.h"

/* A DXF file in the profile of AAMA and ASTM (D6673): each block is a piece in one size, layers say
 * the meaning of its lines, and texts "KEY: VALUE" name it. All functions are local. */

enum dxf_layer {
    DXF_BOUNDARY = 1,
    DXF_TURN_POINTS = 2,
    DXF_NOTCHES = 4,
    DXF_MIRROR = 6,
    DXF_GRAIN = 7,
    DXF_SEW = 14,
    DXF_OTHER_NOTCHES = 80, /* T; castles, checks and round ones follow */
    DXF_LAST_NOTCHES = 83
};

enum { DXF_PIECES = 1 << 14, DXF_LINES = 1 << 11, DXF_PLACES = 1 << 16 }; /* at most; of a piece */

/* A polyline of n places of its piece, from `first` on. */
struct dxf_line {
    enum dxf_layer layer;
    uint32_t first, n;
    bool closed; /* the last place is joined to the first */
    size_t at;   /* line of the file */
};

struct dxf_piece {
    char *block, *name;        /* NULL: it has none; the name is that of the block then */
    char *size;                /* NULL: it is of all */
    uint32_t copies, mirrored; /* how many are cut as drawn, and mirrored; both 0: not told */
    size_t at;                 /* line of the file */
    struct cloth_list line;    /* struct dxf_line */
    struct cloth_list place;   /* double[2], in the file's unit, of lines */
    struct cloth_list turn;    /* double[2]: points where edges meet */
    struct cloth_list notch;   /* double[2] */
};

struct dxf {
    const char *path;
    double unit;             /* m */
    char *sample;            /* the size that is drawn first; NULL: not told */
    struct cloth_list piece; /* struct dxf_piece: those with a boundary */
};

/* Reads the file as text. CLOTH_E_INPUT names file and line; CLOTH_E_IO, CLOTH_E_MEMORY. dxf_free
 * in any case. */
int dxf_read(struct dxf *dxf, const char *path, struct cloth_error *error);
void dxf_free(struct dxf *dxf);

/* Fails with "FILE:LINE: message". */
int dxf_fail(const struct dxf *dxf, size_t at, struct cloth_error *error, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* The file's pairs, one after the other. `value` lives as long as `bytes`, which the caller frees.
 */
struct dxf_text {
    const struct dxf *dxf;
    struct cloth_error *error;
    char *bytes, *next; /* of the file, a zero behind them; what is not read yet */
    size_t line;        /* of the value */
    long code;
    char *value;
    bool over; /* there is no pair any more */
};
int dxf_text_open(struct dxf_text *text, const struct dxf *dxf, struct cloth_error *error);
int dxf_text_next(struct dxf_text *text);
/* The value as a coordinate. */
int dxf_text_number(struct dxf_text *text, double *value);

/* A closed loop of places in the file's unit; corner: where edges of the panel meet. */
struct dxf_loop {
    struct cloth_list stop; /* struct dxf_stop */
    bool closed, unfolded;
};
struct dxf_stop {
    double x[2];
    bool corner, notch; /* notch: it may become a corner */
};

/* The loop of a piece's sew line, or of its boundary if it has none that closes; unfolded at the
 * mirror line, with two corners or more. notches: these are corners, too. The caller frees
 * loop->stop.items in any case. Errors: CLOTH_E_INPUT for a boundary that is open, CLOTH_E_MEMORY.
 */
int dxf_loop_make(struct dxf_loop *loop, const struct dxf *dxf, const struct dxf_piece *piece,
                  bool notches, struct cloth_error *error);

/* The first line of a layer; NULL: there is none. */
const struct dxf_line *dxf_line_of(const struct dxf_piece *piece, enum dxf_layer layer);

#endif
