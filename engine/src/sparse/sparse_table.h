/* The table of isoslice-sparse.so: CXSparse, of SuiteSparse.
 *
 * CXSparse and not CHOLMOD: it is plain C without BLAS, whose sums depend on the processor. */
#ifndef ISO_SPARSE_SPARSE_TABLE_H
#define ISO_SPARSE_SPARSE_TABLE_H

#include <stdint.h>

#include "solid/module.h"

typedef struct sparse_lower sparse_lower;

/* The upper half of a symmetric matrix by columns, in any order within one, no place twice. */
typedef struct sparse_columns {
    int32_t size;
    const int32_t *first; /* [size + 1] */
    const int32_t *row;   /* [first[size]] at most that of the column */
    const double *value;
} sparse_columns;

typedef struct sparse_table {
    module_header header;

    /* ISO_NO_MEMORY, or ISO_USAGE: not positive definite. */
    iso_status (*factorise)(sparse_lower **lower, const sparse_columns *matrix);
    /* x[size] and scratch[size] apart from each other; x holds b before. */
    void (*solve)(double *x, const sparse_lower *lower, double *scratch);
    void (*free)(sparse_lower *lower);
} sparse_table;

#endif
