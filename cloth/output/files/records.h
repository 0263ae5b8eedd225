#ifndef CLOTH_OUTPUT_FILES_RECORDS_H
#define CLOTH_OUTPUT_FILES_RECORDS_H

#include "cloth/output/colours.h"

/* The form of DIR/colours.bin, which its writer and its reader share. */
extern const char output_colours_name[];

enum { OUTPUT_COLOURS_HEADER = 16, OUTPUT_RECORD_HEADER = 16 };
extern const unsigned char output_colours_header[OUTPUT_COLOURS_HEADER];

enum output_record_kind {
    OUTPUT_RECORD_BLOCKS,
    OUTPUT_RECORD_RANKS,
    OUTPUT_RECORD_REST,
    OUTPUT_RECORDS
};
struct output_record {
    uint32_t kind, frame;
    uint64_t size; /* bytes behind the header */
};
void output_record_put(unsigned char bytes[OUTPUT_RECORD_HEADER],
                       const struct output_record *record);
struct output_record output_record_get(const unsigned char bytes[OUTPUT_RECORD_HEADER]);

/* Bytes of a record of shapes; it is as large as its counts say. */
enum {
    OUTPUT_REST_COUNTS = 12,
    OUTPUT_REST_TRIANGLE = 36,
    OUTPUT_REST_EDGE = 12,
    OUTPUT_REST_MATERIAL = 20
};
uint64_t output_rest_size(const struct element_strains *rest);
void output_rest_put(unsigned char *bytes, const struct element_strains *rest);
/* rest has room for its counts. False: numbers that are out of range or not finite. */
bool output_rest_get(const unsigned char *bytes, struct element_strains *rest);

#endif
