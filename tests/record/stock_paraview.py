# ParaView's NetCDF reader must open a record as a time series of (z, x) images.
# Arguments: record, number of frames, last time (s), largest and mean psi of the last frame. Exit 77: ParaView is not there.
import sys

try:
    from paraview.simple import NetCDFReader
    from paraview import servermanager
except ImportError as error:
    print("skipped: no ParaView here (%s)" % error)
    sys.exit(77)

path, frames, last_time, largest, mean = sys.argv[1], int(sys.argv[2]), float(sys.argv[3]), float(sys.argv[4]), float(sys.argv[5])
reader = NetCDFReader(FileName=[path])
reader.UpdatePipelineInformation()
times = list(reader.TimestepValues)
assert len(times) == frames, "%d time steps, expected %d" % (len(times), frames)
assert abs(times[-1] - last_time) <= 1e-12, times[-1]
assert list(reader.GetProperty("Dimensions").Available) == ["(z, x)"], list(reader.GetProperty("Dimensions").Available)
reader.UpdatePipeline(times[-1])
image = servermanager.Fetch(reader)
psi = image.GetCellData().GetArray("psi")  # ParaView draws a cell around each node
assert psi is not None, "no psi among the cell data"
values = [psi.GetValue(i) for i in range(psi.GetNumberOfTuples())]
assert abs(max(values) - largest) < 1e-6, max(values)
assert abs(sum(values) / len(values) - mean) < 1e-6, sum(values) / len(values)
print("ParaView: %d time steps of %d values" % (len(times), len(values)))
