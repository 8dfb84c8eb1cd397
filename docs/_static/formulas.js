// Sets the formulas of a page by KaTeX.
document.addEventListener("DOMContentLoaded", () => renderMathInElement(document.body, {
  delimiters: [{ left: "\\(", right: "\\)", display: false }, { left: "\\[", right: "\\]", display: true }],
  throwOnError: false,
}));
