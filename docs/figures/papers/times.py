"""Error against time: every method that looks at maps beside those that find exact masks and areas, on the default scene and on the one
whose light is largest."""

from chart import Chart
from drawing import BLUE, DARK, INK, RED, Drawing
from experiment import TRUTH, measures, rounded

SCENES = (("bunny", "scenes/bunny.json"), ("large-penumbra", "scenes/large-penumbra.json"))
EXACT = ["edge-scatter", "view-sample"]
IMAGE = ["shadow-map", "pcf", "pcss", "vssm", "convolution", "occlusion-textures", "soft-shadow-map", "backproject", "backproject-peel",
         "bitmask", "contour", "packet", "accumulate", "adaptive-light", "layered-attenuation", "deep-penumbra"]
SIZE, RUNS = 128, 1


def measure(runner):
    data = {}
    for name, path in SCENES:
        found = runner.compare(path, EXACT + IMAGE, size=SIZE, runs=RUNS, samples=256)
        data[name] = [[TRUTH, rounded(found["truth"]["light"]), rounded(found["truth"]["evaluate"]), 0.0]]
        for entry in EXACT + IMAGE:
            error = measures(found, entry, ("rmse",))["rmse"]
            data[name].append([entry, rounded(found[entry]["light"]), rounded(found[entry]["evaluate"]), error])
    return data


def draw(data):
    d = Drawing(900, 46 + 390 * len(data), "Error against time of all methods that look at maps",
                "A chart a scene: seconds of a changed light against the root mean square error of V. Filters are fast and "
                "wrong by 0.04 to 0.09, backprojection is slower and nearer, methods with a map a light sample are slowest; exact edges are fast and right.")
    seconds = [light + evaluate for rows in data.values() for _, light, evaluate, _ in rows]
    ends = (0.8 * min(seconds), 1.3 * max(seconds))
    ticks = [t for t in (0.001, 0.01, 0.1, 1, 10, 100) if ends[0] <= t <= ends[1]]
    for k, (name, rows) in enumerate(data.items()):
        top = 46 + 390 * k
        errors = [row[3] for row in rows if row[3] > 0]
        low = 10 ** -3 if min(errors) > 1e-3 else 10 ** -4
        chart = Chart(d, (56, top, 520, 300), ends, (low, 0.3), f"scenes/{name}.json", "seconds when the light has changed", "RMSE of V", log_x=True,
                      log_y=True, x_ticks=ticks, y_ticks=[t for t in (0.0001, 0.001, 0.01, 0.1) if t >= low])
        d.text((606, top - 10), "seconds; RMSE of V", 12, bold=True)
        for i, (entry, light, evaluate, error) in enumerate(rows):
            colour = RED if i <= len(EXACT) else BLUE
            at = chart.at(light + evaluate, min(max(error, low), 0.3))
            d.circle(at, 8, "#ffffff", colour, 1.5)
            d.text((at[0], at[1] + 4), str(i + 1), 10, INK, "middle")
            y = top + 8 + 16.4 * i
            d.text((622, y), str(i + 1), 11, colour, "end")
            d.text((628, y), "rows=exact" if entry == TRUTH else entry, 11, DARK)
            d.text((816, y), f"{light + evaluate:.2g}", 11, DARK, "end")
            d.text((880, y), f"{error:.4f}" if error else "0", 11, DARK, "end")
    d.text((56, 34 + 390 * len(data)), f"{SIZE}² pixels, 256 light samples, every option as it is by default. Number 1, exact areas, has no error. A processor that others used, too.", 11.5)
    return d.finish()


FIGURES = {"times": (measure, draw)}
