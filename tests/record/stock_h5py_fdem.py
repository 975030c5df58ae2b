# Stock h5py must open an FDEM record and find what was written, enough to make a table of edges with their ends and damage of it.
# Arguments: record, frames, edges, edges of initial cracks, broken edges of the last frame, area of the triangles (m^2). Exit 77: no h5py.
import sys

try:
    import h5py
    import numpy
except ImportError as error:
    print("skipped: no h5py here (%s)" % error)
    sys.exit(77)

path, frames, edges, cracks, broken, area = sys.argv[1], *(int(word) for word in sys.argv[2:6]), float(sys.argv[6])
with h5py.File(path, "r") as record:
    assert record.attrs["method"] == b"fdem" and record.attrs["fracfarm_schema"] == b"fracfarm.record/3"
    damage = record["damage"]
    assert damage.shape == (frames, edges) and damage.dtype == numpy.dtype("<f4"), (damage.shape, damage.dtype)
    assert [damage.dims[d][0].name for d in range(2)] == ["/time", "/edge"] and damage.fletcher32 and damage.compression == "gzip"
    assert (damage[:] * 8192 % 1 == 0).all(), "not multiples of 2^-13"
    last = damage[-1]
    assert (last == 2).sum() == cracks and (last == 1).sum() == broken, ((last == 2).sum(), (last == 1).sum())
    assert ((record["edge_kind"][:] == 1) == (damage[0] == 2)).all()
    nodes, triangles = record["node_xyz"][:], record["tri_nodes"][:]
    assert nodes.shape[1] == 3 and (nodes[:, 1] == 0).all() and triangles.dtype == numpy.dtype("<i4")
    a, b, c = (nodes[triangles[:, k]][:, [0, 2]] for k in range(3))
    sizes = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    assert (sizes > 0).all() and abs(sizes.sum() - area) < 1e-12, sizes.sum()
    ends = nodes[record["edge_nodes"][:]].reshape(edges, 6)
    table = numpy.column_stack([ends, record["damage_failure"][:]])  # x1 y1 z1 x2 y2 z2 damage
    assert table.shape == (edges, 7) and numpy.isfinite(table).all()
    broke = record["break_time"][:]
    assert ((record["break_mode"][:] > 0) == numpy.isfinite(broke)).all()
    assert ((table[:, 6] == 1) == (broke <= record.attrs["time_to_failure"])).all()
    print("h5py: %d frames of %d edges" % (frames, edges))
