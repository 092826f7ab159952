/* A multi-link of every kind, for what has to work with all of them. */
#ifndef TESTS_LINK_SAMPLES_H
#define TESTS_LINK_SAMPLES_H

#include <isoslice/link.h>

/* Make sample `kind`; ISO_KIND_COUNT gives a second coloured link, a slice with a projection more.
 * The caller frees it. */
iso_status make_sample(iso_multilink *out, int kind) ISO_MUST_CHECK;
const char *sample_name(int kind);

enum { SAMPLE_COUNT = ISO_KIND_COUNT + 1 };

#endif
