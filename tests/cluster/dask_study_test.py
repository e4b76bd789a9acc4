"""A study over Dask's workers, of which one is killed on the way, has the same table as one in this process.

Usage, with a Python that has Dask (tools/dask_here) and finds plica: dask_study_test.py [POINTS]
"""
import os
import signal
import sys
import threading
import time

from distributed import Client, LocalCluster

import plica

STUDY = {
    "scenario": "drosophila",
    "set": {"time.end_min": 4},
    "vary": {
        "contraction.apical.stiffness_nN_per_um": {"low": 3, "high": 8},
        "elasticity.young_modulus_Pa": {"low": 500, "high": 1500},
    },
    "keep": {"measures": ["furrow_depth_um", "vml_apical_area_ratio"]},
}


def main():
    points = int(sys.argv[1]) if len(sys.argv) > 1 else 60
    study = STUDY | {"design": {"kind": "latin-hypercube", "points": points}}
    here = plica.Study(study).run(jobs=1)
    killed = []
    with LocalCluster(n_workers=4, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:

        def kill():
            while not client.processing() or not any(client.processing().values()):
                time.sleep(0.05)
            time.sleep(1)
            victim = next(worker for worker, tasks in client.processing().items() if tasks)
            killed.append(victim)
            os.kill(client.run(os.getpid)[victim], signal.SIGKILL)

        thread = threading.Thread(target=kill)
        thread.start()
        there = plica.Study(study).run(executor=client.get_executor(pure=False))
        thread.join()
    same = here.drop(columns="wall_s").equals(there.drop(columns="wall_s"))
    print(f"{len(there)} rows from Dask's workers, {len(killed)} of them killed: {'the same' if same else 'other rows'}")
    return 0 if same and killed else 1


if __name__ == "__main__":
    raise SystemExit(main())
