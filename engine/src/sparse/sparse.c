#include "sparse/sparse.h"

#include <math.h>
#include <stddef.h>

#include "base/memory.h"
#include "sparse/sparse_table.h"

struct sparse_factor {
    const sparse_table *table;
    sparse_lower *lower;
    int32_t size;
};

typedef struct columns {
    int32_t *first, *row;
    double *value;
    int32_t *seen; /* where a row's entry of the column at hand is */
} columns;

static void columns_free(columns *c) {
    iso_release(c->first);
    iso_release(c->row);
    iso_release(c->value);
    iso_release(c->seen);
}

static iso_status columns_new(columns *c, int64_t count, int32_t size) {
    *c = (columns){0};
    iso_status status = ISO_ALLOCATE(c->first, (int64_t)size + 2);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(c->row, count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(c->value, count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(c->seen, size);
    if (status != ISO_OK)
        columns_free(c);
    return status;
}

static iso_status check(const sparse_entry *entry, int64_t count, int32_t size) {
    if (size < 1 || count > INT32_MAX)
        return iso_fail(ISO_USAGE, "a matrix of %d rows and %lld entries can't be factorised", size,
                        (long long)count);
    for (int64_t i = 0; i < count; i++)
        if (entry[i].column < 0 || entry[i].row < entry[i].column || entry[i].row >= size ||
            !isfinite(entry[i].value))
            return iso_fail(ISO_USAGE, "entry %lld, of row %d and column %d, is wrong (%g)",
                            (long long)i, entry[i].row, entry[i].column, entry[i].value);
    return ISO_OK;
}

/* The lower half by rows is the upper half by columns. Entries keep their order, and so do sums. */
static void gather(columns *c, const sparse_entry *entry, int64_t count, int32_t size) {
    memset(c->first, 0, ((size_t)size + 2) * sizeof *c->first);
    for (int64_t i = 0; i < count; i++)
        c->first[entry[i].row + 2]++;
    for (int32_t k = 2; k < size + 2; k++)
        c->first[k] += c->first[k - 1];
    for (int64_t i = 0; i < count; i++) {
        int32_t at = c->first[entry[i].row + 1]++;
        c->row[at] = entry[i].column;
        c->value[at] = entry[i].value;
    }
}

/* Add up what is of one place. */
static void merge(columns *c, int32_t size) {
    int32_t used = 0;
    for (int32_t k = 0; k < size; k++)
        c->seen[k] = -1;
    for (int32_t k = 0, from = 0; k < size; k++) {
        int32_t end = c->first[k + 1], begin = used;
        for (; from < end; from++) {
            int32_t row = c->row[from];
            if (c->seen[row] >= begin) {
                c->value[c->seen[row]] += c->value[from];
                continue;
            }
            c->seen[row] = used;
            c->row[used] = row;
            c->value[used++] = c->value[from];
        }
        c->first[k] = begin;
    }
    c->first[size] = used;
}

static iso_status factorise(sparse_factor *factor, const columns *c) {
    const sparse_columns matrix = {factor->size, c->first, c->row, c->value};
    iso_status status = factor->table->factorise(&factor->lower, &matrix);
    if (status == ISO_NO_MEMORY)
        return iso_fail(status, "out of memory for a system of %d unknowns", factor->size);
    if (status != ISO_OK)
        return iso_fail(status, "a system of %d unknowns isn't positive definite", factor->size);
    return ISO_OK;
}

iso_status sparse_factorise(sparse_factor **factor, const sparse_entry *entry, int64_t count,
                            int32_t size) {
    *factor = NULL;
    ISO_TRY(check(entry, count, size));
    const void *table;
    ISO_TRY(module_open(&table, ISO_MODULE_SPARSE));
    sparse_factor *made = iso_allocate(sizeof *made);
    if (!made)
        return iso_no_memory(sizeof *made);
    *made = (sparse_factor){.table = table, .size = size};
    columns c;
    iso_status status = columns_new(&c, count, size);
    if (status == ISO_OK) {
        gather(&c, entry, count, size);
        merge(&c, size);
        status = factorise(made, &c);
        columns_free(&c);
    }
    if (status != ISO_OK) {
        sparse_free(made);
        return status;
    }
    *factor = made;
    return ISO_OK;
}

iso_status sparse_solve(double *x, const sparse_factor *factor, const double *b) {
    double *scratch;
    ISO_TRY(ISO_ALLOCATE(scratch, factor->size));
    memmove(x, b, (size_t)factor->size * sizeof *x);
    factor->table->solve(x, factor->lower, scratch);
    iso_release(scratch);
    return ISO_OK;
}

void sparse_free(sparse_factor *factor) {
    if (!factor)
        return;
    if (factor->lower)
        factor->table->free(factor->lower);
    iso_release(factor);
}
