"""Runs the code of the notebooks in this folder, as CI does: `python docs/notebooks/run.py [FOLDER]`. Their plots go to FOLDER as PNG."""

import json
import sys
import time
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def run(notebook: Path, plots: "Path | None") -> None:
    """Runs the cells in order, in one place, as a kernel would."""
    names: dict = {"__name__": "__main__"}
    shown = []

    def show() -> None:
        if plots is not None:
            plt.savefig(plots / f"{notebook.stem}-{len(shown)}.png", dpi=60, bbox_inches="tight")
        shown.append(plt.gcf())
        plt.close("all")

    plt.show = show
    for i, cell in enumerate(json.loads(notebook.read_text(encoding="utf-8"))["cells"]):
        if cell["cell_type"] == "code":
            code = compile("".join(cell["source"]), f"{notebook.name}, cell {i}", "exec")
            exec(code, names)
    if not shown:
        raise SystemExit(f"{notebook.name} shows no plot")


if __name__ == "__main__":
    folder = Path(__file__).parent
    plots = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    for notebook in sorted(folder.glob("*.ipynb")):
        start = time.monotonic()
        run(notebook, plots)
        print(f"{notebook.name}: {time.monotonic() - start:.1f} s")
