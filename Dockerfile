# docker build -t suchus .
# docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/work" suchus   # the demo's page, into this folder
# docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/work" suchus run displacement --quick
# docker run --rm -p 8080:8080 suchus view --host 0.0.0.0            # then open the address that it prints
FROM python:3.11-slim

# libgomp is what numba's threads are made of
# hadolint ignore=DL3008
RUN apt-get update \
 && apt-get install --yes --no-install-recommends libgomp1 \
 && rm -rf /var/lib/apt/lists/*

WORKDIR /source
COPY pyproject.toml README.md LICENSE constraints.txt ./
COPY src src
RUN python -m pip install --no-cache-dir --constraint constraints.txt '.[viewer,optimise]'

# whoever runs it can write what is made anew
ENV XDG_CACHE_HOME=/tmp/cache MPLCONFIGDIR=/tmp/matplotlib
RUN useradd --uid 1000 walker && install --directory --owner=walker /work
USER 1000
WORKDIR /work
ENTRYPOINT ["suchus"]
CMD ["demo", "--no-browser"]
