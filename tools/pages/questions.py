"""The shelf of experiments as a page: one section per question."""

from suchus.experiments import EXPERIMENTS
from suchus.paper import CLAIMS


def page() -> str:
    """Return the page of all experiments."""
    apart = ", ".join(f"`{name}`" for name, one in EXPERIMENTS.items() if not one.reproduces)
    lines = [
        "# Questions",
        "",
        "Each experiment is a question with parameters. `suchus run NAME` answers one, `suchus reproduce` all but",
        "those that take minutes and judge nothing of the article (" + apart + ");",
        "`suchus run NAME --help` lists what can be changed.",
        "",
        "| experiment | question | article |",
        "|---|---|---|",
    ]
    lines += [f"| [`{name}`](#{name}) | {one.title} | {one.shows} |" for name, one in EXPERIMENTS.items()]
    for name, one in EXPERIMENTS.items():
        code = f"[`suchus.experiments.{name}`][suchus.experiments.{name}.experiment]"
        lines += ["", f"## {one.title} {{#{name}}}", "", f"{one.shows}. Code: {code}", ""]
        lines += ["```sh", f"suchus run {name}", "```", ""]
        if one.claims:
            lines += ['??? note "Statements of the article that it judges"', ""]
            lines += [f"    * [{CLAIMS[key].sense}](verdicts.md#{key}) *({CLAIMS[key].where})*" for key in one.claims]
    return "\n".join([*lines, ""])
