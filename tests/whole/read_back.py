"""The state at each frame of a run, of its probes: positions and velocities of all vertices."""
import csv
import os


def states(folder):
    """A list of (time, positions, velocities), one a frame; lists of three numbers a vertex."""
    with open(os.path.join(folder, 'frames.csv')) as file:
        times = [row['time'] for row in csv.DictReader(file)]
    with open(os.path.join(folder, 'probes.csv')) as file:
        rows = {row['time [s]']: row for row in csv.DictReader(file)}
    result = []
    for time in times:
        row = next(row for key, row in rows.items() if abs(float(key) - float(time)) < 1e-9)
        names = [name for name in row if name.split('.')[-1] in ('x [m]', 'vx [m/s]')]
        vectors = {'x [m]': [], 'vx [m/s]': []}
        for name in names:
            axis, unit = name.split('.')[-1].split(' ')
            begin = name[:-len(name.split('.')[-1])]
            vector = [float(row[begin + axis[:-1] + c + ' ' + unit]) for c in 'xyz']
            vectors[axis + ' ' + unit].append(vector)
        result.append((float(time), vectors['x [m]'], vectors['vx [m/s]']))
    return result
