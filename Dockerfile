# docker build -t suchus .
# docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/work" suchus   # the demo's page, into this folder
# docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/work" suchus run displacement --quick
# docker run --rm -p 8080:8080 suchus view --host 0.0.0.0            # then open the address that it prints
# the digest of the image for every kind of machine; a newer one: docker buildx imagetools inspect python:3.11-slim
FROM python:3.11-slim@sha256:9c900dea9e8fb7e16277c179b555cc72d29a352dbc33cff48ad5a0412fd5bfc7

# libgomp is what numba's threads are made of
# hadolint ignore=DL3008
RUN apt-get update \
 && apt-get install --yes --no-install-recommends libgomp1 \
 && rm -rf /var/lib/apt/lists/*

WORKDIR /source
COPY pyproject.toml README.md LICENSE pins.txt ./
COPY tools/needs.py tools/needs.py
COPY src src
RUN sed -n '/^pip==/,/[^\\]$/p' pins.txt > pip.txt \
 && python tools/needs.py viewer optimise > needs.txt \
 && python -m pip install --no-cache-dir --require-hashes --requirement pip.txt \
 && python -m pip install --no-cache-dir --require-hashes --constraint pins.txt --requirement needs.txt \
 && python -m pip install --no-cache-dir --no-deps --build-constraint pins.txt .

# whoever runs it can write what is made anew
ENV XDG_CACHE_HOME=/tmp/cache MPLCONFIGDIR=/tmp/matplotlib
RUN useradd --uid 1000 walker && install --directory --owner=walker /work
USER 1000
WORKDIR /work
ENTRYPOINT ["suchus"]
CMD ["demo", "--no-browser"]
