#ifndef TESTS_SUPPORT_SCARCE_H
#define TESTS_SUPPORT_SCARCE_H

/* Memory that runs out. The linker puts the functions of scarce.c in the place of malloc's family:
 * a program that has them takes $(SCARCE_WRAP). */

/* Allocations of this thread until one fails; negative: none does any more. */
extern _Thread_local long scarce_left;

#endif
