"use strict";
// The theme puts the copy button of every code block into a <nav>: landmarks by the dozen, all without a name.
const quiet = () => {
  for (const nav of document.querySelectorAll("nav.md-code__nav:not([role])")) nav.setAttribute("role", "none");
};
new MutationObserver(quiet).observe(document.documentElement, { childList: true, subtree: true });
quiet();
