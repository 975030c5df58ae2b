# Stock h5py must open a record and find what was written: numbers, units, dimension scales, filters, fixed-length ASCII.
# Arguments: record, number of frames, last time (s), largest and mean psi of the last frame. Exit 77: no h5py.
import sys

try:
    import h5py
    import numpy
except ImportError as error:
    print("skipped: no h5py here (%s)" % error)
    sys.exit(77)

path, frames, last_time, largest, mean = sys.argv[1], int(sys.argv[2]), float(sys.argv[3]), float(sys.argv[4]), float(sys.argv[5])
with h5py.File(path, "r") as record:
    assert record.attrs["Conventions"] == b"CF-1.10" and record.attrs["fracfarm_schema"] == b"fracfarm.record/3"
    psi = record["psi"]
    assert psi.shape[0] == frames and psi.dtype == numpy.dtype("<f4"), (psi.shape, psi.dtype)
    assert psi.shape[1:] == (record["z"].shape[0], record["x"].shape[0])
    assert [record["psi"].dims[d][0].name for d in range(3)] == ["/time", "/z", "/x"]
    assert psi.shuffle and psi.compression == "gzip" and psi.fletcher32 and psi.chunks[1:] == psi.shape[1:]
    assert abs(record["time"][-1] - last_time) <= 1e-12 and record["time"].attrs["units"] == b"s" and record["time"].attrs["axis"] == b"T"
    last = psi[-1]
    assert abs(float(last.max()) - largest) < 1e-6 and abs(float(last.mean(dtype="f8")) - mean) < 1e-6
    assert (psi[:] * 8192 % 1 == 0).all(), "not multiples of 2^-13"
    assert (psi[:][:, record["mask_initial"][:] == 1] == 1).all()
    rows = record["series/step_time"].shape[0]
    for name, column in record["series"].items():
        assert column.shape == (rows,) and column.attrs["units"]
        assert name == "step_time" or column.dims[0][0].name == "/series/step_time"
    assert b"fracfarm.scene/1" in record["provenance/canonical_scene"][:].tobytes()
    rules = [rule.tobytes().rstrip(b"\0").decode() for rule in record["failure/rule"][:]]
    assert record["failure"].attrs["chosen_rule"].decode() in rules, rules
    assert record["checks/passed"][:].all() and len(record["checks/name"]) == len(record["checks/value"])

    def checksummed(name, item):
        if isinstance(item, h5py.Dataset) and item.size:
            assert item.fletcher32, name + " carries no checksum"

    record.visititems(checksummed)
    print("h5py: %d frames, %d series rows" % (frames, rows))
