"""A page on which a tissue is painted, folded, cut and compared while it is simulated."""
from __future__ import annotations

import fcntl
import os
import secrets
import threading
import webbrowser
from pathlib import Path
from typing import IO, TYPE_CHECKING, Optional, Union

from ..errors import PlicaError, needed
from ..scenario import Scenario

if TYPE_CHECKING:
    from .server import Server

__all__ = ["Studio", "studio"]


class Studio:
    """Studio that serves its page in a thread of this process; a notebook shows the page in the cell.

    Attributes
    ----------
    url : str
        Address of the page, with its token: anyone on this machine who has it can use the studio.
    """

    def __init__(self, server: Server, lock: IO[str]) -> None:
        self._server, self._lock = server, lock
        self._thread = threading.Thread(target=server.run, name="plica studio", daemon=True)

    @property
    def url(self) -> str:
        return self._server.url

    def start(self) -> None:
        self._thread.start()

    def serve(self) -> None:
        """Serve in this thread, until Ctrl-C."""
        self._server.run()

    def stop(self) -> None:
        """End the server after the step under way; the same folder resumes its runs."""
        self._server.stop()
        self._thread.join()
        self._lock.close()

    def _repr_html_(self) -> str:
        return f'<iframe src="{self.url}" width="100%" height="800" style="border:0"></iframe>'


def made(scenario: Union[Scenario, str, os.PathLike[str], None], folder: Union[str, os.PathLike[str]], port: int,
         threads: Optional[int]) -> Studio:
    """Make the studio of a folder, not yet serving."""
    for module in ("starlette", "uvicorn", "websockets"):
        needed(module, "plica studio")
    from .draft import Draft
    from .server import Server

    start = Path(folder).resolve()
    home = start / ".plica-studio"
    home.mkdir(mode=0o700, exist_ok=True)
    lock = (home / "address").open("a+")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        lock.seek(0)
        raise PlicaError(f"{start}: has an open studio, at {lock.read().strip()}; "
                         "open that, or give another folder") from None
    # The same address as before, so that a page that is open, or a kept link, finds a restarted studio.
    lock.seek(0)
    earlier = lock.read().strip()
    before, _, token = earlier.partition("/?token=")
    port = port or int(before.rpartition(":")[2] or 0)
    draft = None if scenario is None else Draft.of(scenario)
    server = Server(start, token or secrets.token_urlsafe(24), port=port, threads=threads)
    if draft is not None:
        server.session.open(draft)
    lock.truncate(0)
    lock.write(server.url + "\n")
    lock.flush()
    os.chmod(home / "address", 0o600)
    return Studio(server, lock)


def studio(scenario: Union[Scenario, str, os.PathLike[str], None] = None, *, folder: Union[str, os.PathLike[str]] = ".",
           port: int = 0, threads: Optional[int] = None, browser: bool = False) -> Studio:
    """Open a studio: a local page to paint regions, set forces, run, cut, go back and compare.

    Parameters
    ----------
    scenario : Scenario, str or path, optional
        Scenario to begin with; by default the one that the folder's studio had, or a choice of built-in ones.
    folder : str or path
        Start folder: files below it can be opened, and ``.plica-studio`` in it keeps the runs.
    port : int, optional
        Port on this machine; by default the one of the folder's last studio, or a free one.
    threads : int, optional
        Threads per step, as for `Simulation`.
    browser : bool
        Open the page in a browser; a notebook shows it in the cell.

    Returns
    -------
    Studio
        The running studio, with its `url`.

    Raises
    ------
    MissingExtra
        Without Starlette, uvicorn and websockets (``pip install 'plica[studio]'``).
    PlicaError
        If the folder has an open studio.

    Examples
    --------
    >>> import plica
    >>> studio = plica.studio("furrow-slice")  # doctest: +SKIP
    >>> studio.url  # doctest: +SKIP
    'http://127.0.0.1:43125/?token=…'
    """
    made_one = made(scenario, folder, port, threads)
    made_one.start()
    if browser:
        webbrowser.open(made_one.url)
    return made_one
