// Accessibility of a page: controls without a label, and text of low contrast.
(() => {
  const named = (e) =>
    e.labels?.length || e.getAttribute("aria-label") || (e.matches("button, circle") && e.textContent.trim());
  const nameless = [...document.querySelectorAll("button, input, select, [role], [tabindex], section, nav, aside")]
    .filter((e) => !e.matches("[role=status], [role=note], [role=alert]") && !named(e))
    .map((e) => e.outerHTML.slice(0, 160));

  // WCAG 2 contrast of at least 4.5 : 1 against the nearest background of at least half opacity.
  const numbers = (color) => color.match(/[\d.]+/g).map(Number);
  const linear = (c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
  const luminance = ([r, g, b]) => 0.2126 * linear(r / 255) + 0.7152 * linear(g / 255) + 0.0722 * linear(b / 255);
  const behind = (e) => {
    for (let one = e; one; one = one.parentElement) {
      const color = numbers(getComputedStyle(one).backgroundColor);
      if (!(color[3] < 0.5)) return color;
    }
    return [0, 0, 0];
  };
  const contrast = (e) => {
    const both = [getComputedStyle(e).color, null].map((c) => luminance(c ? numbers(c) : behind(e)));
    return (Math.max(...both) + 0.05) / (Math.min(...both) + 0.05);
  };
  const faint = [...document.querySelectorAll("button, label, h2, p, span, summary, select, b, output")]
    .filter((e) => [...e.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim()))
    .filter((e) => e.checkVisibility() && !e.closest(":disabled, [inert], .muted"))
    .filter((e) => contrast(e) < 4.5)
    .map((e) => `${contrast(e).toFixed(2)} ${e.outerHTML.slice(0, 120)}`);
  return { nameless, faint };
})();
