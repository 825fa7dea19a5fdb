"""Runs, resumes, prints and draws the sweeps of the command line."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from compare.cli.command import (
    BAD_INPUT,
    FINE,
    INTERRUPTED,
    NOTHING_SHOWN,
    SOMETHING_DIFFERS,
    BadInputError,
    printing,
    refused,
    say,
    trajectories,
)
from compare.cli.options import check_folder
from compare.output.outside_text import reason_of

if TYPE_CHECKING:
    from compare.sweep.compute.executors import Executor
    from compare.sweep.files import Files
    from compare.sweep.plan import Plan
    from compare.sweep.store import SweepStore

STORE = "sweep.zarr"
CHUNK = 32768
MOST_UNDECIDED = 0.5  # largest share of undecided trajectories for exit status 0


def run_sweep(plan: Plan, chunk: int | None, scheduler: str | None, place: str, resume: bool) -> int:
    """Run or resume a sweep, print and draw its results, and return the exit status."""
    from compare.run.workers import lacks_memory
    from compare.sweep.compute.executors import ClusterError
    from compare.sweep.compute.run import run
    from compare.sweep.compute.work import OtherCodeError
    from compare.sweep.files import Files, StoreError
    from compare.sweep.store import SweepStore
    from reference_model.simulation import prepare

    folder, store = Files.at(place), None
    files = Files.at(folder.below(STORE))
    try:
        with _executor(scheduler) as executor:
            with _reporting_store_errors():
                _check_writable(folder)
                store = _existing_store(files, plan, chunk, resume)
            prepare()
            with trajectories() as progress:
                if store is None:
                    store = SweepStore.create(files.url, plan, chunk or CHUNK)
                run(store, executor, progress)
        store.pack()
        if store.broken:
            say(f"recomputed damaged parts of {store.path!r}: {'; '.join(store.broken)}", FINE)
        return finish(store, folder)
    except FileExistsError:
        return say(
            f"another command has just started {files.url!r}; wait until it ends, or choose another --output",
            BAD_INPUT,
        )
    except (ClusterError, OtherCodeError) as error:
        return say(f"{error}. Repeat the command with --resume to continue.", SOMETHING_DIFFERS)
    except (OSError, MemoryError, StoreError) as error:
        if lacks_memory(error):
            return say("not enough memory. Repeat the command with --resume to continue.", SOMETHING_DIFFERS)
        return say(
            f"{error}. Results written so far remain valid; repeat the command with --resume to continue.",
            BAD_INPUT,
        )
    except KeyboardInterrupt:
        return say("Interrupted. Repeat the command with --resume to continue.", INTERRUPTED)
    finally:
        if store is not None:
            store.tidy()


@contextmanager
def _reporting_store_errors() -> Iterator[None]:
    from compare.sweep.files import StoreError

    with refused():
        try:
            yield
        except StoreError as error:
            raise BadInputError(str(error)) from None


def _check_writable(folder: Files) -> None:
    from compare.sweep.files import is_remote

    if is_remote(folder.url):
        folder.write({f"{STORE}.try": b""})
        folder.remove(f"{STORE}.try")
    else:
        check_folder(Path(folder.url))


def _existing_store(files: Files, plan: Plan, chunk: int | None, resume: bool) -> SweepStore | None:
    from compare.sweep.store import SweepStore, is_free

    if is_free(files):
        return None
    store = SweepStore.open(files.url)
    try:
        _check_same(store, plan, chunk, resume)
    except ValueError:
        store.tidy()
        raise
    return store


def _check_same(store: SweepStore, plan: Plan, chunk: int | None, resume: bool) -> None:
    from compare.run.provenance import stamp

    if store.plan != plan:
        raise ValueError(f"{store.path!r} contains a different sweep; choose another --output")
    if not resume:
        raise ValueError(
            f"{store.path!r} already exists; use --resume to continue it, or choose another --output"
        )
    if store.stamp != stamp():
        raise ValueError(
            f"{store.path!r} was computed by a different version of the code or libraries; choose another --output"
        )
    if chunk not in (None, store.chunk):
        raise ValueError(f"chunk = {chunk}: {store.path!r} uses chunks of {store.chunk}; leave out --chunk")


@contextmanager
def _executor(scheduler: str | None) -> Iterator[Executor]:
    from compare.sweep.compute.executors import Cluster, ClusterError, InProcess

    if scheduler is None:
        yield InProcess()
        return
    try:
        cluster = Cluster(scheduler)
    except (ValueError, ClusterError) as error:
        raise BadInputError(str(error)) from None
    except ModuleNotFoundError:
        raise BadInputError("--scheduler needs Dask; install it with: pip install distributed") from None
    with cluster:
        yield cluster


def finish(store: SweepStore, folder: Files) -> int:
    """Print and draw the results; return 1 if the plain reference differs, 3 if too many are undecided, else 0."""
    from compare.sweep.figures import write_figures
    from compare.sweep.summary import same_ends, summary, undecided

    written = write_figures(store, folder)
    with printing():
        for line in summary(store):
            print(line)
        print(f"Results: {store.path}; figures: {', '.join(written)}")
    if not same_ends(store):
        return SOMETHING_DIFFERS
    if undecided(store) > MOST_UNDECIDED:
        return say(
            f"{100.0 * undecided(store):.0f} % of the trajectories are undecided; use a larger --until",
            NOTHING_SHOWN,
        )
    return FINE


def redraw(place: str) -> int:
    """Call ``finish`` for a stored sweep; raise ``BadInputError`` if it is incomplete."""
    from compare.sweep.files import Files
    from compare.sweep.store import SweepStore

    with _reporting_store_errors():
        folder = Files.at(place)
        store = SweepStore.open(folder.below(STORE))
        try:
            _check_writable(folder)
            _check_finished(store)
            return finish(store, folder)
        except (LookupError, TypeError, AttributeError) as error:
            reason = f"{type(error).__name__} {reason_of(error)}"
            raise ValueError(f"{store.path!r} does not contain what it describes: {reason}") from None
        finally:
            store.tidy()


def _check_finished(store: SweepStore) -> None:
    from compare.sweep.compute.run import finished

    if finished(store):
        return
    if store.broken:
        raise ValueError(
            f"{store.path!r} is damaged ({'; '.join(store.broken)}); repeat the sweep with --resume to recompute it"
        )
    raise ValueError(f"the sweep in {store.path!r} is not finished; repeat it with --resume to complete it")
