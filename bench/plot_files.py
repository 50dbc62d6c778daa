"""What the plot scripts share: tables in, pictures out."""
import h5py
import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "drape"})
import matplotlib.pyplot as plt


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
