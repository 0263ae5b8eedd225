#!/bin/sh
# The runtime on several ranks: each case prints TAP of its own; here it must end well, on time.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

# loaded: Open MPI's own way to give cores away, which tests/support/mpi.sh asks for, would be counted as well.
# plans: the sums of 5 ranks and more go from rank to rank.
cases tests/runtime/ranks << 'END'
acquire        | 2 1 3     | the program works on objects in place
adopt          | 2 1 3     | memory of the program's own
await          | 2 1 3     | requests of MPI that bodies hand over
control        | 2 5 8     | few messages until all ranks agree
cut            | 2 1 3     | messages longer than their receives
delegate       | 2 1 3     | tasks that run on other ranks than their own
delegate       | 2         | the same in checking mode | DUITE_CHECK=accesses
homes          | 2 3       | what settles the homes of objects
itself         | 2 1       | nothing that was switched off
kernels        | 2 1 3     | kernels that are added
loaded         | 2         | ranks sleep beside eight loops | OMPI_MCA_mpi_yield_when_idle=0
mappings       | 2         | wrong mappings
migrate        | 2 1 3     | objects that move
migrate_values | 2 1 3     | what they take along
migrate_values | 2         | the same in checking mode | DUITE_CHECK=accesses
mpi            | 2 1 3+    | MPI of the program's own
parts          | 2 1 3     | objects become parts, and whole again
plans          | 2 1 3     | messages of a round
plans          | 5 8+ 16+  | messages of a round
prune          | 2 1 3     | what ranks keep of others' tasks and objects
replicated     | 2 1 3     | replicated kernels
sizes          | 2 1 3     | a list goes round
subtrees       | 2 1 3     | whole subtrees run elsewhere
subtrees       | 2         | the same in checking mode | DUITE_CHECK=accesses
tags           | 2 1 3     | few tags
tasks          | 2 1 3     | mappings see tasks
wait_for       | 2 1 3     | waits for some objects, and gets that are ended later
wide           | 2 1 3     | 40 listed parameters
wide           | 1         | the same in checking mode | DUITE_CHECK=accesses
END
