/* Cholesky factors by CXSparse: T. A. Davis, Direct Methods for Sparse Linear Systems, 2006. */
#define NCOMPLEX
#include <suitesparse/cs.h>

#include <stdlib.h>

#include "sparse/sparse_table.h"

enum { AMD_OF_SUM = 1 }; /* approximate minimum degree of A + A' */

struct sparse_lower {
    int32_t size;
    cs_dis *order;
    cs_din *factor;
};

static void lower_free(sparse_lower *lower) {
    if (!lower)
        return;
    cs_di_sfree(lower->order);
    cs_di_nfree(lower->factor);
    free(lower);
}

/* CXSparse says NULL for whatever went wrong. The factor is by far the largest of what it needs, so
 * whether there is room for one more tells what it was. */
static iso_status what_failed(const cs_dis *order) {
    void *room = malloc((size_t)order->lnz * (sizeof(int) + sizeof(double)) + 1);
    free(room);
    return room ? ISO_USAGE : ISO_NO_MEMORY;
}

static iso_status lower_factorise(sparse_lower **lower, const sparse_columns *matrix) {
    *lower = NULL;
    sparse_lower *made = calloc(1, sizeof *made);
    if (!made)
        return ISO_NO_MEMORY;
    int32_t count = matrix->first[matrix->size];
    const cs_di columns = {.nzmax = count,
                           .m = matrix->size,
                           .n = matrix->size,
                           .p = (int *)matrix->first,
                           .i = (int *)matrix->row,
                           .x = (double *)matrix->value,
                           .nz = -1};
    made->size = matrix->size;
    made->order = cs_di_schol(AMD_OF_SUM, &columns);
    iso_status status = !made->order || made->order->lnz > INT32_MAX ? ISO_NO_MEMORY : ISO_OK;
    if (status == ISO_OK) {
        made->factor = cs_di_chol(&columns, made->order);
        status = made->factor ? ISO_OK : what_failed(made->order);
    }
    if (status != ISO_OK) {
        lower_free(made);
        return status;
    }
    *lower = made;
    return ISO_OK;
}

static void lower_solve(double *x, const sparse_lower *lower, double *scratch) {
    cs_di_ipvec(lower->order->pinv, x, scratch, lower->size);
    cs_di_lsolve(lower->factor->L, scratch);
    cs_di_ltsolve(lower->factor->L, scratch);
    cs_di_pvec(lower->order->pinv, scratch, x, lower->size);
}

MODULE_TABLE const sparse_table isoslice_module = {
    {MODULE_VERSION_SPARSE}, lower_factorise, lower_solve, lower_free};
