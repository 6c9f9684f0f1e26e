"""The study of a session in its state folder: parts as they come, so that a restart of the server loses none.

The folder is one that ``schuler study --resume`` would go on with (`navcore.study.results.Folder`).
"""

import logging
from pathlib import Path

from navcore.foundation.errors import InputError
from navcore.questions.study import StudyQuestion
from navcore.scenario.model import Scenario
from navcore.study.studied import Studied
from schuler_bench.http.ids import log_name
from schuler_bench.jobs.asking import Asker
from schuler_bench.jobs.words import without_folders
from schuler_bench.session.folder import empty_study, opened

_log = logging.getLogger("schuler.store")


def keep_study(studier: Asker, path: Path, where: str) -> None:
    """Let a session's studies be kept in a folder, and take up what an earlier server has left there.

    Parameters
    ----------
    studier : Asker
        Of the session; has no study yet.
    path : Path
        The folder; need not exist.
    where : str
        Name in faults of a study that is taken up; empty: it is of the session's own scenario.
    """
    if path.is_dir():
        try:
            found = _reopened(path, where)
        except (InputError, OSError, ValueError, KeyError) as error:  # of another version, or damaged
            why = without_folders(str(error))  # the folder is named after the session's address
            _log.warning("the study of session %s cannot be resumed: %.200s", log_name(path.stem), why)
        else:
            if found is not None:
                studier.asked, studier.result = found
    studier.prepared = lambda asked: asked.model_copy(update={"folder": _emptied(path)})


def _reopened(path: Path, where: str) -> tuple[StudyQuestion, Studied] | None:
    """Study and results of a folder; None where no run is complete."""
    from navcore.study.file import load
    from navcore.study.plan import Plan
    from navcore.study.results import RUNS_FILE, STUDY_FILE
    from navcore.study.results import Folder as Results
    from navcore.study.study import carry_out

    if not (path / STUDY_FILE).exists():
        return None
    plan = Plan(load(str(path / STUDY_FILE)), where)
    results = Results(path, plan)
    with results.opened(resume=True):
        document = carry_out(plan, results, 1, stopped=lambda: True)
    if not document["runs"]:
        return None
    own = plan.study.scenario
    present = None if where or isinstance(own, str) else Scenario.parse(own)
    task = StudyQuestion(study=plan.study, where=where, scenario=present, workers=1)
    return task, Studied(document, (path / RUNS_FILE).read_bytes())


def _emptied(path: Path) -> Path | None:
    """Give the folder for a new study; None where it cannot be had, and the study is not kept."""
    try:
        with opened(path, make=True) as folder:
            empty_study(folder, path)
    except OSError as error:
        _log.warning("a study is not kept over a restart: %s", error.strerror)
        return None
    return path
