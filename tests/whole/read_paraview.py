"""pvpython read_paraview.py FOLDER: ParaView's readers find in each frame of the folder the state, bit for bit."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
import read_back

folder = sys.argv[1]
states = read_back.states(folder)


def compare(data, position, velocity, what):
    points = vtk_to_numpy(data.GetPoints().GetData())
    speeds = vtk_to_numpy(data.GetPointData().GetArray('velocity'))
    ranks = set(vtk_to_numpy(data.GetPointData().GetArray('rank')).tolist())
    if points.tolist() != position or speeds.tolist() != velocity or ranks != {0, 1}:
        sys.exit(f'{what}: not the state (ranks {ranks})')
    print(f'{what}: {len(position)} vertices, positions and velocities are the state\'s')


reader = simple.OpenDataFile(os.path.join(folder, 'cloth.xmf'))
reader.UpdatePipeline()
times = list(reader.TimestepValues)
if len(states) < 4 or times != [time for time, _, _ in states]:
    sys.exit(f'cloth.xmf has the times {times}')
for k, (time, position, velocity) in enumerate(states):
    reader.UpdatePipeline(time)
    compare(servermanager.Fetch(reader), position, velocity, f'cloth.xmf at {time} s')
    own = simple.VTKHDFReader(FileName=[os.path.join(folder, 'hdf5', f'frame-{k:06d}.vtkhdf')])
    compare(servermanager.Fetch(own), position, velocity, f'frame {k}')
