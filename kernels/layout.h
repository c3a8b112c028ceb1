// Constants shared by OpenCL C and C++. The only file that both include.
#ifndef PLIANT_LAYOUT_H
#define PLIANT_LAYOUT_H

// Element data are stored in tiles of 16 elements. A tile holds its planes one after the other, 16 numbers each: plane p of
// element e is at (e / TILE) * PLANES * TILE + p * TILE + e % TILE.
#define PLIANT_TILE 16

// A brick is 16 x 4 x 4 nodes of a lattice (x fastest) and the cells whose low corner they are.
#define PLIANT_BRICK_X 16
#define PLIANT_BRICK_Y 4
#define PLIANT_BRICK_Z 4
#define PLIANT_BRICK_NODES 256
// Force output of a brick: 5 x 5 rows (z, then y) of 3 components of 16 nodes, then for each row the 3 components of the node
// at x = 16, padded to a multiple of 16.
#define PLIANT_BRICK_ROWS 25
#define PLIANT_BRICK_FORCE 1280
#define PLIANT_BRICK_FORCE_X16 1200
// brick_neighbor: 8 bricks at (+x, +y, +z) by bit mask (0 is the brick itself), then 8 at (-x, -y, -z); absent: the empty
// brick.
#define PLIANT_BRICK_NEIGHBORS 16
// brick_rows: per brick the rows (bit 4 z + y) with cells, and the rows with nodes; other rows are skipped.

// Planes per tile.
#define PLIANT_TET_DATA_PLANES 10       // dN1..dN3 / dX (9) [1/m], volume [m^3]
#define PLIANT_HEX_DATA_PLANES 56       // b (24) [1/m], hourglass control (31, hex8_hourglass.cl), V [m^3]
#define PLIANT_HEX_CUBE_RECORD 58       // of a cube, one for all: b (24) [1/m], gamma (32), V [m^3], k [N/m]
#define PLIANT_HEXFULL_DATA_PLANES 200  // 8 points x (grad N (24) [1/m], weight [m^3])
#define PLIANT_TET_FORCE_PLANES 12      // 4 corners x 3 components [N]
#define PLIANT_HEX_FORCE_PLANES 24      // 8 corners x 3 components [N]
#define PLIANT_SPRING_PLANES 8          // see spring_force.cl
#define PLIANT_MEMBRANE_DATA_PLANES 10  // unit tangents (6) [1], dN_1/dX_1, dN_1/dX_2, dN_2/dX_2 [1/m], volume [m^3]
#define PLIANT_MEMBRANE_FORCE_PLANES 9  // 3 corners x 3 components [N]

#define PLIANT_FAULT_SUMMARY 4  // numbers written by each of the 256 work-items of fault_reduce

// Contact of tissue with tissue (touch_point.cl): partners per contact point; planes per partner: area [m^2], gap below which
// it pushes [m], anchor in the frame of the lower point (3) [m], whether it is set; planes of a point's position, of its
// undeformed surface, of the forces of its partners (3 and whether it pushed); numbers per box and per node of the tree of
// boxes; the bit in contact_near.
#define PLIANT_TOUCH_SLOTS 16
#define PLIANT_TOUCH_PAIR 6
#define PLIANT_TOUCH_PLACE 20
#define PLIANT_TOUCH_SURFACE 24
#define PLIANT_TOUCH_FORCE 4
#define PLIANT_TOUCH_MOMENT 8  // per point: moments about its first and second tangent (3 each, then a 0) [quanta]
#define PLIANT_PATCH 34        // per point: bounds of its patch (24) and its embedding (10)
#define PLIANT_TOUCH_BOX 19
#define PLIANT_TOUCH_TREE 4
#define PLIANT_TOUCH_BIT 1073741824
#define PLIANT_READY_BIT 536870912  // among a point's contact bits: it may touch something in the next step

// Shape matching: numbers per region record (four blocks of four), planes of a region's undeformed data per tile.
#define PLIANT_FLSM_RECORD 16
#define PLIANT_FLSM_REST_PLANES 10    // 1 / sum m, centroid (3) [cells], second moment (6)
#define PLIANT_FLSM_SPIN_PLANES 6     // inverse of the undeformed inertia (6)
#define PLIANT_FLSM_ELASTIC_PLANES 7  // inverse of the second moment (6), second moment of the material
#define PLIANT_FLSM_STRAIN 2.25f      // e : e up to which the law of elastic regions is a polynomial (flsm_elastic.cpp)

#endif
