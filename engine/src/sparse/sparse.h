/* Symmetric positive definite systems, by SuiteSparse in a module of its own. */
#ifndef ISO_SPARSE_SPARSE_H
#define ISO_SPARSE_SPARSE_H

#include <stdint.h>

#include <isoslice/status.h>

/* Entries in any order; several of one place add up. Only those with row >= column count: the
 * matrix is symmetric. */
typedef struct sparse_entry {
    int32_t row, column;
    double value;
} sparse_entry;

typedef struct sparse_factor sparse_factor;

/* ISO_BAD_CONFIG: the module is missing; ISO_USAGE: the matrix isn't positive definite. */
iso_status sparse_factorise(sparse_factor **factor, const sparse_entry *entry, int64_t count,
                            int32_t size) ISO_MUST_CHECK;
/* x[size] = A^-1 b[size]; they may be the same array. The same bits every time. */
iso_status sparse_solve(double *x, const sparse_factor *factor, const double *b) ISO_MUST_CHECK;
void sparse_free(sparse_factor *factor);

#endif
