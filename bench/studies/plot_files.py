"""What the plot scripts share: tables in, pictures out."""
import json
import pathlib

import h5py
import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "drape"})
import matplotlib.pyplot as plt


MARKS = {"circle": "o", "square": "s", "square-open": "s", "diamond": "D", "diamond-open": "d", "triangle-up": "^", "triangle-down": "v", "cross": "P", "x": "X",
         "star": "*", "pentagon": "p", "hexagon": "h", "star-diamond": "8", "hourglass": "<"}


def looks():
    """The looks of curves as the report has them: report/looks.js without what makes it a script."""
    text = (pathlib.Path(__file__).parent / "report/looks.js").read_text()
    return json.loads(text[text.index("const looks = ") + len("const looks = "):text.rindex(";")])


def style(name):
    """Colour and mark of a method with its solvers or of a package, as style() in report/plots.js has them."""
    known = looks()
    hashed = lambda text: 7 if not text else (31 * hashed(text[:-1]) + ord(text[-1])) % 1000003
    other = lambda several, text: several[hashed(text) % len(several)]
    method, _, solver = name.partition("/")
    colour = known["methods"].get(method) or other(known["other_colours"], method)
    mark, _ = known["solvers"].get(solver) or other(known["other_marks"], solver)
    return colour, MARKS[mark]


def read_table(path, name):
    """The columns of a table of an HDF5 file by name."""
    with h5py.File(path) as file:
        table = file["tables"][name]
        text = lambda column: table[column].asstr()[:]
        return {key: text(key) if h5py.check_string_dtype(table[key].dtype) else table[key][:] for key in table}


def save(figure, path, name):
    """Writes the figure beside the file it was drawn from: FILE-<name>.png and .svg, the same ones for the same figure."""
    for suffix in ("png", "svg"):
        picture = path.with_name(f"{path.stem}-{name}.{suffix}")
        figure.savefig(picture, dpi=120, metadata={"Date": None} if suffix == "svg" else None)
        print(picture)
    plt.close(figure)
