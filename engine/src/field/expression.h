/* Expressions in a few variables, as a user writes them: "ramp(z, 0, 40, 20, 80)". Compiled once,
 * evaluated over arrays.
 *
 *     numbers, names of variables, pi; + - * / ^ with the usual precedence, ^ to the right;
 *     comparisons < <= > >= == != (1 or 0); condition ? a : b
 *     abs sqrt min max clamp(v, low, high) floor ceil round mod sin cos tan asin acos atan atan2
 *     exp log hypot, ramp(v, from, to, a, b): a below `from`, b above `to`, linear between
 *
 * sin, cos, exp and the like are series of our own: the same on every machine. Angles in radians.
 */
#ifndef ISO_FIELD_EXPRESSION_H
#define ISO_FIELD_EXPRESSION_H

#include <stdbool.h>
#include <stdint.h>

#include <isoslice/status.h>

typedef struct iso_expression iso_expression;

/* `name` is [count]; at most 32 variables. ISO_BAD_CONFIG with the column and what was expected; an
 * empty text is a mistake too. */
iso_status expression_compile(iso_expression **expression, const char *text,
                              const char *const *name, int32_t count) ISO_MUST_CHECK;
void expression_free(iso_expression *expression);

/* Does the value depend on this variable? */
bool expression_uses(const iso_expression *expression, int32_t variable);

/* value[i] = the expression at variable[k][i]; variable[k] may be NULL where it isn't used. Never
 * fails: what has no value (1 / 0, the root of -1) is NaN or infinite, as with IEEE 754. Any number
 * of threads at once; no allocation. value may be one of the variables' arrays. */
void expression_evaluate(double *value, const iso_expression *expression,
                         const double *const *variable, int64_t count);

#endif
