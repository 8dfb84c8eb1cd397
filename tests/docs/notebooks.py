#!/usr/bin/env python3
"""Tests the notebooks of the documentation: notebooks.py [--write] PROGRAM NOTEBOOK.ipynb...

Executes the notebooks and compares the outputs with the stored ones. With --write it stores the new outputs instead,
and removes what a notebook server adds.

Each notebook runs in a temporary folder, in which `experiments` is a link to that of the repository, with the package
pkmopt of the repository and the library of PROGRAM's build, on one thread. Texts have to be equal, because results of
pkmopt are equal on every machine; pictures have to exist where they are stored."""
import base64
import os
import sys
import tempfile
from pathlib import Path

import nbformat
from jupyter_client.manager import AsyncKernelManager
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

REPOSITORY = Path(__file__).resolve().parents[2]
PICTURES = ("image/png", "image/svg+xml")


def execute(path, program):
    """Returns the notebook with new outputs."""
    notebook = nbformat.read(path, as_version=4)
    library = program.parent.parent / "lib" / "libpkmopt.so.0"
    os.environ.update(PYTHONPATH=str(REPOSITORY / "bindings" / "python"), PYTHONDONTWRITEBYTECODE="1",
                      PKMOPT_LIBRARY=str(library), OMP_NUM_THREADS="1", PYDEVD_DISABLE_FILE_VALIDATION="1")
    with tempfile.TemporaryDirectory() as folder:
        os.environ.update(IPYTHONDIR=folder, MPLCONFIGDIR=folder, JUPYTER_RUNTIME_DIR=folder)  # no settings of the user
        os.symlink(REPOSITORY / "experiments", Path(folder) / "experiments")
        # Sockets in the folder: two tests at once could choose the same port.
        kernel = AsyncKernelManager(kernel_name="python3", transport="ipc", connection_file=folder + "/kernel.json")
        NotebookClient(notebook, km=kernel, timeout=120, record_timing=False,
                       resources={"metadata": {"path": folder}}).execute(cleanup_kc=True)
    return notebook


def simplified(outputs):
    """Outputs without what depends on the session; consecutive parts of a stream are joined."""
    simple = []
    for output in outputs:
        if output.output_type == "stream":
            if simple and simple[-1].output_type == "stream" and simple[-1].name == output.name:
                simple[-1].text += output.text
            else:
                simple.append(nbformat.v4.new_output("stream", name=output.name, text=output.text))
        else:
            data = {kind: value for kind, value in output.data.items() if kind in ("text/plain", *PICTURES)}
            count = {"execution_count": output.execution_count} if output.output_type == "execute_result" else {}
            simple.append(nbformat.v4.new_output(output.output_type, data=data, **count))
    return simple


def comparable(output):
    if output.output_type == "stream":
        return output.name, output.text
    pictures = [kind for kind in PICTURES if output.data.get(kind)]
    png = output.data.get("image/png")
    if png and not base64.b64decode(png).startswith(b"\x89PNG"):
        pictures = ["an invalid picture"]
    return output.output_type, output.data.get("text/plain", ""), *pictures


def clean(notebook):
    """Prepares a notebook for storing."""
    notebook.metadata = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"},
                         "language_info": {"name": "python"}}
    for number, cell in enumerate(notebook.cells, 1):
        cell.id, cell.metadata = "cell-%d" % number, {}
        if cell.cell_type == "code":
            cell.outputs = simplified(cell.outputs)


def differences(stored, executed):
    """Sentences, one for each cell whose outputs differ."""
    for number, (old, new) in enumerate(zip(stored.cells, executed.cells), 1):
        if old.cell_type != "code":
            continue
        expected, found = ([comparable(each) for each in simplified(cell.outputs)] for cell in (old, new))
        if expected != found:
            yield "cell %d: %s\n  expected: %s\n  found:    %s" % (number, old.source.splitlines()[0], expected, found)


def main():
    arguments = sys.argv[1:]
    write = arguments[:1] == ["--write"]
    program, *paths = arguments[write:]
    wrong = 0
    for path in paths:
        stored = nbformat.read(path, as_version=4)
        try:
            executed = execute(path, Path(program).resolve())
        except CellExecutionError as error:
            print("%s: a cell fails\n%s" % (path, error))
            wrong += 1
            continue
        if write:
            clean(executed)
            nbformat.write(executed, path)
        else:
            for sentence in differences(stored, executed):
                print("%s: %s" % (path, sentence))
                wrong += 1
    sys.exit(bool(wrong) or not paths)


if __name__ == "__main__":
    main()
