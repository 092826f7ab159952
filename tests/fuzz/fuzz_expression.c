/* Bytes as an expression: what compiles has values, and the same ones in blocks of any size. */
#include "fuzz.h"

#include <string.h>

#include "field/expression.h"

enum { VALUES = 40 };

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    static const char *const names[] = {"x", "y", "z", "skin", "r", "grid"};
    static char text[1 << 14];
    static double place[6][VALUES], whole[VALUES], single[VALUES];
    const double *from[6];
    if (size >= sizeof text)
        return 0;
    memcpy(text, bytes, size);
    text[size] = 0;
    iso_expression *expression = NULL;
    iso_status status = expression_compile(&expression, text, names, 6);
    if (status != ISO_OK) {
        if (status != ISO_BAD_CONFIG || expression || !strstr(iso_error_message(), "column "))
            abort();
        return 0;
    }
    for (int k = 0; k < 6; k++)
        for (int i = 0; i < VALUES; i++)
            place[k][i] = (i - 17) * (k + 1) * 0.37;
    for (int k = 0; k < 6; k++)
        from[k] = expression_uses(expression, k) ? place[k] : NULL;
    expression_evaluate(whole, expression, from, VALUES);
    for (int i = 0; i < VALUES; i++) {
        for (int k = 0; k < 6; k++)
            from[k] = expression_uses(expression, k) ? place[k] + i : NULL;
        expression_evaluate(single + i, expression, from, 1);
        if (single[i] != whole[i] && (single[i] == single[i] || whole[i] == whole[i]))
            abort();
    }
    expression_free(expression);
    return 0;
}
