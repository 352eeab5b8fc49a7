"""A job array of Slurm's, for clusters where no Dask shall run: every task is one command of the program."""
from __future__ import annotations

import shlex
from typing import Sequence

from ._farm_job import Job
from ._farm_plan import Part

SCRIPT = """#!/bin/bash
#SBATCH --job-name=whit
#SBATCH --array=0-{last}
#SBATCH --cpus-per-task={threads}
#SBATCH --output={folder}/%a.log
# {scene} in {count} parts, as whit-farm cut it. Scene, program and folder must be seen under these names everywhere.
#   sbatch THIS      renders all parts; a task that is run again goes on where its checkpoint was
#   bash THIS merge  joins them when all are done
set -euo pipefail
whit={program}
folder={folder}
mkdir -p "$folder"
cd {here}
if [[ ${{1-}} == merge ]]; then
  parts=()
  for ((i = 0; i <= {last}; ++i)); do parts+=("$folder/$i.part"); done
  exec "$whit" merge "${{parts[@]}}"{outfile}
fi
parts=(
{parts}
)
n=$SLURM_ARRAY_TASK_ID
state=$folder/$n.part
keep=(--checkpoint "$state")
[[ ! -e $state ]] || keep=(--resume "$state")
# shellcheck disable=SC2086  # a part is several words
exec "$whit" {scene}{flags} ${{parts[n]}} "${{keep[@]}}" --nthreads {threads} --outfile none --quiet
"""


def slurm_script(job: Job, parts: Sequence[Part], threads: int, outfile: str, folder: str, program: str) -> str:
    """The text of the script. Paths are absolute."""
    quote = shlex.quote
    return SCRIPT.format(
        last=len(parts) - 1, count=len(parts), threads=threads, folder=quote(folder), program=quote(program),
        here=quote(job.scene.rpartition("/")[0] or "/"), scene=quote(job.scene),
        flags="".join(" " + quote(f) for f in job.flags), parts="\n".join(f"  {quote(' '.join(p.flags()))}" for p in parts),
        outfile=f" --outfile {quote(outfile)}" if outfile else "")
