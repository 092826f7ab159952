/* ISO_SORT(name, type, less): define `static void name(type *array, int64_t count)`, sorting in
 * place by the strict order `less(const type *a, const type *b)`. No allocation, O(n log n) at
 * worst, and for a total order the same result whatever the input's order. libc's qsort allocates
 * and calls through a pointer. */
#ifndef ISO_BASE_SORT_H
#define ISO_BASE_SORT_H

#include <stdint.h>

#define ISO_SORT(name, type, less)                                                                 \
    static void name##_insert(type *array, int64_t count) {                                        \
        for (int64_t i = 1; i < count; i++) {                                                      \
            type moved = array[i];                                                                 \
            int64_t j = i;                                                                         \
            for (; j > 0 && less(&moved, &array[j - 1]); j--)                                      \
                array[j] = array[j - 1];                                                           \
            array[j] = moved;                                                                      \
        }                                                                                          \
    }                                                                                              \
    static void name##_sift(type *array, int64_t root, int64_t count) {                            \
        type moved = array[root];                                                                  \
        for (int64_t child; (child = 2 * root + 1) < count; root = child) {                        \
            if (child + 1 < count && less(&array[child], &array[child + 1]))                       \
                child++;                                                                           \
            if (!less(&moved, &array[child]))                                                      \
                break;                                                                             \
            array[root] = array[child];                                                            \
        }                                                                                          \
        array[root] = moved;                                                                       \
    }                                                                                              \
    static void name##_heap(type *array, int64_t count) {                                          \
        for (int64_t i = count / 2; i-- > 0;)                                                      \
            name##_sift(array, i, count);                                                          \
        for (int64_t i = count; i-- > 1;) {                                                        \
            type top = array[0];                                                                   \
            array[0] = array[i];                                                                   \
            array[i] = top;                                                                        \
            name##_sift(array, 0, i);                                                              \
        }                                                                                          \
    }                                                                                              \
    static void name##_quick(type *array, int64_t count, int depth) {                              \
        while (count > 24) {                                                                       \
            if (depth-- == 0) {                                                                    \
                name##_heap(array, count);                                                         \
                return;                                                                            \
            }                                                                                      \
            type a = array[0], b = array[count / 2], c = array[count - 1];                         \
            type pivot = less(&a, &b) ? (less(&b, &c)   ? b                                        \
                                         : less(&a, &c) ? c                                        \
                                                        : a)                                       \
                                      : (less(&a, &c)   ? a                                        \
                                         : less(&b, &c) ? c                                        \
                                                        : b);                                      \
            int64_t i = 0, j = count - 1;                                                          \
            for (;;) {                                                                             \
                while (less(&array[i], &pivot))                                                    \
                    i++;                                                                           \
                while (less(&pivot, &array[j]))                                                    \
                    j--;                                                                           \
                if (i >= j)                                                                        \
                    break;                                                                         \
                type t = array[i];                                                                 \
                array[i++] = array[j];                                                             \
                array[j--] = t;                                                                    \
            }                                                                                      \
            int64_t left = j + 1;                                                                  \
            if (left < count - left) {                                                             \
                name##_quick(array, left, depth);                                                  \
                array += left;                                                                     \
                count -= left;                                                                     \
            } else {                                                                               \
                name##_quick(array + left, count - left, depth);                                   \
                count = left;                                                                      \
            }                                                                                      \
        }                                                                                          \
        name##_insert(array, count);                                                               \
    }                                                                                              \
    static void name(type *array, int64_t count) {                                                 \
        int depth = 4;                                                                             \
        for (int64_t n = count; n > 1; n /= 2)                                                     \
            depth += 2;                                                                            \
        name##_quick(array, count, depth);                                                         \
    }

#endif
