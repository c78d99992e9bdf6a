// SPDX-License-Identifier: Apache-2.0
// Which triangles with corner normals count as flat.
#ifndef CLRT_SHARED_FLAT_FACET_H
#define CLRT_SHARED_FLAT_FACET_H

/* cos of 0.01: a triangle whose corner normals are all within this angle of its plane's is flat. A vn of two
   decimals, the fewest that exporters write, is off by up to half a hundredth on each axis, which tilts it by
   at most 0.0087. Balls of more than 300 segments around, whose faces meet at less than 0.02, count as flat
   too. */
#define FLAT_FACET_COS 0.99995f

#endif
