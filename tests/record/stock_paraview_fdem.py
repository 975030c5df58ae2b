# ParaView's NetCDF reader must open an FDEM record as a time series of damage along the edges.
# Arguments: record, number of frames, last time (s), edges, mean damage of the last frame. Exit 77: ParaView is not there.
import sys

try:
    from paraview.simple import NetCDFReader
    from paraview import servermanager
except ImportError as error:
    print("skipped: no ParaView here (%s)" % error)
    sys.exit(77)

path, frames, last_time, edges, mean = sys.argv[1], int(sys.argv[2]), float(sys.argv[3]), int(sys.argv[4]), float(sys.argv[5])
reader = NetCDFReader(FileName=[path])
reader.UpdatePipelineInformation()
times = list(reader.TimestepValues)
assert len(times) == frames, "%d time steps, expected %d" % (len(times), frames)
assert abs(times[-1] - last_time) <= 1e-12, times[-1]
print(list(reader.GetProperty("Dimensions").Available))
reader.Dimensions = "(edge)"
reader.UpdatePipeline(times[-1])
line = servermanager.Fetch(reader)
fields = [line.GetCellData(), line.GetPointData()]
damage = next((field.GetArray("damage") for field in fields if field.GetArray("damage")), None)
assert damage is not None, "no damage among the data"
values = [damage.GetValue(i) for i in range(damage.GetNumberOfTuples())]
assert len(values) == edges and max(values) == 2.0, (len(values), max(values))
assert abs(sum(values) / len(values) - mean) < 1e-6, sum(values) / len(values)
print("ParaView: %d time steps of %d edges" % (len(times), len(values)))
