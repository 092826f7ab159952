/* Ways from the mould's side around the part and back. */
#ifndef ISO_CHANNEL_ROUTE_H
#define ISO_CHANNEL_ROUTE_H

#include "channel/curve.h"

/* The side of the mould that ports are on. */
typedef struct port_side {
    iso_vec3 out, along; /* unit vectors; out x along is z turned down: along x z = out */
    double face;         /* mm, the side's place along `out` */
    double half;         /* mm from the middle of two ports to each of them */
    int32_t axis;        /* of `out`: 0 is x, 1 is y */
} port_side;

/* A ring opened where it is nearest to the side: from its end at larger `along` around to the
 * other. *middle between the ends is where it says, if it can be, else (or from NaN) at the middle
 * of the ring's width or as near to that as can be; it comes back as it is. ISO_NOT_VERIFIED: the
 * ring is too small for two ports. */
iso_status route_open(curve *out, double *middle, const curve *ring,
                      const port_side *side) ISO_MUST_CHECK;

/* The open way between ports at both of its ends, leg[0] and leg[1] mm from the side. */
iso_status route_ports(curve *out, double leg[2], const curve *way,
                       const port_side *side) ISO_MUST_CHECK;

/* Append the points of an opened ring, backwards perhaps. */
iso_status route_append(curve *out, const curve *opened, bool backwards) ISO_MUST_CHECK;

#endif
